#include "rig_firmware/stereo/disparity/upsample_pass.h"

#include "rig_firmware/stereo/features/halve_pass.h"

namespace vantage {

UpsamplePass::UpsamplePass(const ShaderLibrary& library, const StereoLayout& coarse,
                           const StereoLayout& fine, DisparityForm form)
    : coarse_(coarse),
      fine_(fine),
      form_(form),
      program_(Program::compute(library, "stereo_upsample.comp",
                                {{"CONFIDENCE", form == DisparityForm::words ? "1" : "0"}})),
      disparity_(fine.pixels() * bytes_per_disparity(form), GL_DYNAMIC_COPY) {}

void UpsamplePass::run(PassProfiler& profiler, const Buffer& coarse_disparity,
                       const Buffer& coarse_luma, const Buffer& fine_luma) {
    const std::size_t pixels = fine_.pixels();
    // The coarse disparity and luma and the fine luma are read.
    const std::size_t bytes_per_pixel = 3 + bytes_per_disparity(form_);
    profiler.run("upsample", {pixels * bytes_per_pixel, static_cast<double>(pixels) * 67}, [&] {
        program_.use();
        program_.set("coarse_size", Eigen::Vector2i(coarse_.width_px, coarse_.height_px));
        program_.set("coarse_stride", coarse_.stride_px());
        program_.set("coarse_row_words", coarse_.luma_row_words());
        program_.set("fine_size", Eigen::Vector2i(fine_.width_px, fine_.height_px));
        program_.set("fine_stride", fine_.stride_px());
        program_.set("fine_row_words", fine_.luma_row_words());
        coarse_disparity.bind_storage(0);
        coarse_luma.bind_storage(1);
        fine_luma.bind_storage(2);
        disparity_.bind_storage(3);
        program_.dispatch_over((coarse_.width_px + 3) / 4, coarse_.height_px);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    });
}

UpsampleRowsPass::UpsampleRowsPass(const ShaderLibrary& library, const StereoLayout& fine,
                                   DisparityForm form)
    : fine_(fine),
      form_(form),
      program_(Program::compute(library, "stereo_upsample_rows.comp",
                                {{"CONFIDENCE", form == DisparityForm::words ? "1" : "0"}})),
      disparity_(fine.pixels() * bytes_per_disparity(form), GL_DYNAMIC_COPY) {}

void UpsampleRowsPass::run(PassProfiler& profiler, const Buffer& coarse_disparity,
                           const Buffer& coarse_luma, const Buffer& fine_luma) {
    const std::size_t pixels = fine_.pixels();
    const StereoLayout coarse = with_half_the_rows(fine_);
    // The fine luma, half of a coarse one and half of a coarse disparity are read.
    const std::size_t bytes_per_pixel = 4 + bytes_per_disparity(form_);
    profiler.run("upsample", {pixels * bytes_per_pixel, static_cast<double>(pixels) * 25}, [&] {
        program_.use();
        program_.set("coarse_size", Eigen::Vector2i(coarse.width_px, coarse.height_px));
        program_.set("fine_height", fine_.height_px);
        program_.set("stride", fine_.stride_px());
        program_.set("row_words", fine_.luma_row_words());
        coarse_disparity.bind_storage(0);
        coarse_luma.bind_storage(1);
        fine_luma.bind_storage(2);
        disparity_.bind_storage(3);
        program_.dispatch_over((coarse.width_px + 3) / 4, coarse.height_px);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    });
}

}  // namespace vantage
