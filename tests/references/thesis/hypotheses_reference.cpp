#include "tests/references/thesis/hypotheses_reference.h"

#include <algorithm>
#include <cstdlib>

namespace vantage::thesis {

CostVolume hypotheses_reference(const ColourImage& left, const ColourImage& right,
                                int disparities) {
    CostVolume volume(left.cols, left.rows, disparities);
    for (int d = 0; d < disparities; ++d)
        for (int y = 0; y < left.rows; ++y)
            for (int x = 0; x < left.cols; ++x) {
                const cv::Vec4b &l = left(y, x), &r = right(y, std::max(x - d, 0));
                const int sum =
                    std::abs(l[0] - r[0]) + std::abs(l[1] - r[1]) + std::abs(l[2] - r[2]);
                volume.at(d, y, x) = static_cast<std::uint16_t>(std::min(sum * 171 / 16, max_cost));
            }
    return volume;
}

}  // namespace vantage::thesis
