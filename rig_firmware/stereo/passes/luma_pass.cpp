#include "rig_firmware/stereo/passes/luma_pass.h"

namespace vantage {

LumaPass::LumaPass(const ShaderLibrary& library, const StereoLayout& layout)
    : layout_(layout),
      program_(Program::compute(library, "stereo_luma.comp")),
      left_(layout.luma_words() * 2 * 4, GL_DYNAMIC_COPY),
      right_(layout.luma_words() * 2 * 4, GL_DYNAMIC_COPY) {}

void LumaPass::run(PassProfiler& profiler, const Texture& left, const Texture& right) {
    const std::size_t pixels = layout_.pixels();
    profiler.run("luma", {pixels * 12, static_cast<double>(pixels) * 24}, [&] {
        program_.use();
        program_.set("picture", 0);
        program_.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
        program_.set("row_words", layout_.luma_row_words());
        for (const auto& [texture, luma] : {std::pair(&left, &left_), std::pair(&right, &right_)}) {
            texture->bind(0);
            luma->bind_storage(0);
            program_.dispatch_over(layout_.luma_row_words(), layout_.height_px);
        }
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    });
}

}  // namespace vantage
