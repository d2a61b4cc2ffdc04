#include "rig_firmware/stereo/thesis/winner_pass.h"

namespace vantage::thesis {

WinnerPass::WinnerPass(const ShaderLibrary& library, cv::Size size)
    : pass_(library, "thesis_winner.comp", size) {}

void WinnerPass::run(const Buffer& costs, int first_disparity, int slices, const Buffer& keys) {
    Program& program = pass_.use();
    program.set("slices", slices);
    program.set("first_disparity", first_disparity);
    costs.bind_storage(0);
    keys.bind_storage(1);
    pass_.dispatch();
}

PassCost WinnerPass::cost(int slices) const {
    const double elements = pass_.pixels() * slices;
    return pass_cost(bytes_per_element * elements + 8 * pass_.pixels(),
                     5 * disparities_per_slice * elements);
}

}  // namespace vantage::thesis
