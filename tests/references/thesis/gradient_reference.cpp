#include "tests/references/thesis/gradient_reference.h"

#include "tests/references/thesis/aggregation_reference.h"
#include "tests/references/thesis/discontinuity_reference.h"
#include "tests/references/thesis/disparity_reference.h"
#include "tests/references/thesis/hypotheses_reference.h"
#include "tests/references/thesis/snf_reference.h"
#include "tests/references/thesis/winner_reference.h"

namespace vantage::thesis {

DisparityImage gradient_reference(const ColourImage& left, const ColourImage& right,
                                  int disparities, const Settings& settings, bool fill) {
    ColourImage filtered = left;
    for (int i = 0; i < settings.snf_iterations; ++i) filtered = snf_reference(filtered);
    const cv::Mat1b discontinuities =
        discontinuity_reference(filtered, settings.discontinuity_threshold);
    CostVolume costs = hypotheses_reference(left, right, disparities);
    for (int i = 0; i < settings.aggregation_passes; ++i)
        costs = aggregation_reference(costs, discontinuities);
    return disparity_reference(winner_reference(costs), fill);
}

}  // namespace vantage::thesis
