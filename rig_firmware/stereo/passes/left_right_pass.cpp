#include "rig_firmware/stereo/passes/left_right_pass.h"

namespace vantage {

LeftRightPass::LeftRightPass(const ShaderLibrary& library, const StereoLayout& layout)
    : layout_(layout),
      clear_(Program::compute(library, "stereo_clear.comp")),
      splat_weighted_(Program::compute(library, "left_right_splat.comp", {{"WEIGHTED", "1"}})),
      splat_(Program::compute(library, "left_right_splat.comp", {{"WEIGHTED", "0"}})),
      resolve_(Program::compute(library, "left_right_resolve.comp")),
      claims_(layout.pixels() * 4, GL_DYNAMIC_COPY),
      disparity_(layout.pixels() * 4, GL_DYNAMIC_COPY) {}

void LeftRightPass::run(PassProfiler& profiler, const Buffer& winners, const Buffer* weight) {
    const std::size_t pixels = layout_.pixels();
    const Eigen::Vector2i size(layout_.width_px, layout_.height_px);
    profiler.run("left-right check", {pixels * 56, static_cast<double>(pixels) * 30}, [&] {
        clear_.use();
        const int vectors = static_cast<int>(pixels / 4);
        clear_.set("count", vectors);
        claims_.bind_storage(0);
        clear_.dispatch_over(vectors, 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        Program& splat = weight ? splat_weighted_ : splat_;
        splat.use();
        splat.set("size", size);
        splat.set("stride", layout_.stride_px());
        winners.bind_storage(0);
        if (weight) weight->bind_storage(1);
        claims_.bind_storage(2);
        splat.dispatch_over(layout_.width_px, layout_.height_px);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        resolve_.use();
        resolve_.set("size", size);
        resolve_.set("stride", layout_.stride_px());
        winners.bind_storage(0);
        claims_.bind_storage(1);
        disparity_.bind_storage(2);
        resolve_.dispatch_over(layout_.width_px, layout_.height_px);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    });
}

}  // namespace vantage
