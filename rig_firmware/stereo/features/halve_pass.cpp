#include "rig_firmware/stereo/features/halve_pass.h"

namespace vantage {

HalvePass::HalvePass(const ShaderLibrary& library, const StereoLayout& fine, HalvedSides sides)
    : fine_(fine),
      coarse_(sides == HalvedSides::both ? halved(fine) : with_half_the_rows(fine)),
      program_(Program::compute(library, "stereo_halve.comp",
                                {{"ROWS_ONLY", sides == HalvedSides::height ? "1" : "0"}})),
      luma_(coarse_.luma_words() * 2 * 4, GL_DYNAMIC_COPY) {}

void HalvePass::run(PassProfiler& profiler, const Buffer& fine_luma) {
    const std::size_t pixels = coarse_.pixels(), fine_pixels = fine_.pixels();
    profiler.run("halve", {(pixels + fine_pixels) * 2, static_cast<double>(pixels) * 60}, [&] {
        program_.use();
        program_.set("fine_size", Eigen::Vector2i(fine_.width_px, fine_.height_px));
        program_.set("fine_row_words", fine_.luma_row_words());
        program_.set("coarse_size", Eigen::Vector2i(coarse_.width_px, coarse_.height_px));
        program_.set("coarse_row_words", coarse_.luma_row_words());
        fine_luma.bind_storage(0);
        luma_.bind_storage(1);
        program_.dispatch_over(coarse_.luma_row_words(), coarse_.height_px, 2);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    });
}

}  // namespace vantage
