#include "rig_firmware/stereo/passes/support_pass.h"

#include "rig_firmware/stereo/passes/support_reference.h"

namespace vantage {

SupportPass::SupportPass(const ShaderLibrary& library, const StereoLayout& layout)
    : layout_(layout), program_(Program::compute(library, "supported_disparity.comp")) {}

void SupportPass::run(PassProfiler& profiler, const Buffer& disparity, const Buffer& supported) {
    const std::size_t pixels = layout_.pixels();
    profiler.run("support", {pixels * 26 * 4, static_cast<double>(pixels) * 25 * 5}, [&] {
        program_.use();
        program_.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
        program_.set("stride", layout_.stride_px());
        program_.set("least_votes", least_support_votes);
        disparity.bind_storage(0);
        supported.bind_storage(1);
        program_.dispatch_over(layout_.width_px, layout_.height_px);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    });
}

}  // namespace vantage
