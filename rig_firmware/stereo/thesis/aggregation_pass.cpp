#include "rig_firmware/stereo/thesis/aggregation_pass.h"

namespace vantage::thesis {

AggregationPass::AggregationPass(const ShaderLibrary& library, cv::Size size)
    : pass_(library, "thesis_aggregation.comp", size, 16) {}

void AggregationPass::run(const Buffer& costs, const Buffer& discontinuities, int slices,
                          const Buffer& aggregated) {
    pass_.use();
    costs.bind_storage(0);
    discontinuities.bind_storage(1);
    aggregated.bind_storage(2);
    pass_.dispatch(slices);
}

PassCost AggregationPass::cost(int slices) const {
    const double elements = pass_.pixels() * slices;
    return pass_cost((2 * bytes_per_element + 4) * elements, 80 * elements);
}

}  // namespace vantage::thesis
