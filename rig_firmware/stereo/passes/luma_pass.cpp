#include "rig_firmware/stereo/passes/luma_pass.h"

namespace vantage {

LumaPass::LumaPass(const ShaderLibrary& library, const StereoLayout& layout)
    : layout_(layout),
      luma_program_(Program::compute(library, "stereo_luma.comp")),
      halve_program_(Program::compute(library, "stereo_halve.comp")),
      halve_shifted_program_(Program::compute(library, "stereo_halve.comp", {{"SHIFTED", "1"}})),
      left_(layout.luma_words() * 4, GL_DYNAMIC_COPY),
      right_(layout.luma_words() * 4, GL_DYNAMIC_COPY) {}

void LumaPass::run(PassProfiler& profiler, const Texture& left, const Texture& right) {
    const std::size_t pixels = layout_.pixels();
    profiler.run("luma", {pixels * 10, static_cast<double>(pixels) * 16}, [&] {
        luma_program_.use();
        luma_program_.set("picture", 0);
        luma_program_.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
        luma_program_.set("row_words", layout_.luma_row_words());
        for (const auto& [texture, luma] : {std::pair(&left, &left_), std::pair(&right, &right_)}) {
            texture->bind(0);
            luma->bind_storage(0);
            luma_program_.dispatch_over(layout_.luma_row_words(), layout_.height_px);
        }
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    });
}

void LumaPass::run_halved(PassProfiler& profiler, const LumaPass& fine,
                          const Buffer& row_shift_votes) {
    const std::size_t pixels = layout_.pixels();
    const auto halve = [&](Program& program, const Buffer& from, const Buffer& to) {
        program.use();
        program.set("fine_size", Eigen::Vector2i(fine.layout_.width_px, fine.layout_.height_px));
        program.set("fine_row_words", fine.layout_.luma_row_words());
        program.set("coarse_size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
        program.set("coarse_row_words", layout_.luma_row_words());
        from.bind_storage(0);
        to.bind_storage(1);
        program.dispatch_over(layout_.luma_row_words(), layout_.height_px);
    };
    profiler.run("halve", {pixels * 10, static_cast<double>(pixels) * 24}, [&] {
        row_shift_votes.bind_storage(2);
        halve(halve_program_, fine.left_, left_);
        halve(halve_shifted_program_, fine.right_, right_);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    });
}

}  // namespace vantage
