#include "rig_firmware/stereo/thesis/snf_pass.h"

namespace vantage::thesis {

SnfPass::SnfPass(const ShaderLibrary& library, cv::Size size)
    : pass_(library, "thesis_snf.comp", size, 16) {}

void SnfPass::run(const Buffer& source, const Buffer& filtered) {
    pass_.use();
    source.bind_storage(0);
    filtered.bind_storage(1);
    pass_.dispatch();
}

}  // namespace vantage::thesis
