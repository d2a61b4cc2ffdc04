#include "rig_firmware/stereo/thesis/hypotheses_pass.h"

namespace vantage::thesis {

HypothesesPass::HypothesesPass(const ShaderLibrary& library, cv::Size size, int disparities)
    : pass_(library, "thesis_hypotheses.comp", size), disparities_(disparities) {}

void HypothesesPass::run(const Buffer& left, const Buffer& right, int first_disparity, int slices,
                         const Buffer& costs) {
    Program& program = pass_.use();
    program.set("first_disparity", first_disparity);
    program.set("disparities", disparities_);
    left.bind_storage(0);
    right.bind_storage(1);
    costs.bind_storage(2);
    pass_.dispatch(slices);
}

PassCost HypothesesPass::cost(int slices) const {
    const double elements = pass_.pixels() * slices;
    return pass_cost((8 + bytes_per_element) * elements, 24 * disparities_per_slice * elements);
}

}  // namespace vantage::thesis
