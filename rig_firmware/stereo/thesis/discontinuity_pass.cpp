#include "rig_firmware/stereo/thesis/discontinuity_pass.h"

namespace vantage::thesis {

DiscontinuityPass::DiscontinuityPass(const ShaderLibrary& library, cv::Size size)
    : pass_(library, "thesis_discontinuities.comp", size) {}

void DiscontinuityPass::run(const Buffer& picture, int threshold, const Buffer& discontinuities) {
    Program& program = pass_.use();
    program.set("threshold", threshold);
    picture.bind_storage(0);
    discontinuities.bind_storage(1);
    pass_.dispatch();
}

}  // namespace vantage::thesis
