#include "rig_firmware/stereo/thesis/aggregation_pass.h"

namespace vantage::thesis {
namespace {

constexpr int rows_each = 16;  // ROWS of the shader

}  // namespace

AggregationPass::AggregationPass(const ShaderLibrary& library, cv::Size size)
    : pass_(library, "thesis_aggregation.comp", size) {}

void AggregationPass::run(const Buffer& costs, const Buffer& discontinuities, int slices,
                          const Buffer& aggregated) {
    pass_.use();
    costs.bind_storage(0);
    discontinuities.bind_storage(1);
    aggregated.bind_storage(2);
    pass_.dispatch(slices, rows_each);
}

PassCost AggregationPass::cost(int slices) const {
    const double elements = pass_.pixels() * slices;
    return pass_cost((2 * bytes_per_element + 4) * elements, 80 * elements);
}

}  // namespace vantage::thesis
