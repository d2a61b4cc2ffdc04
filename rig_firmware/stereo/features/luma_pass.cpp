#include "rig_firmware/stereo/features/luma_pass.h"

#include <string>

namespace vantage {

LumaPass::LumaPass(const ShaderLibrary& library, const StereoLayout& layout, PictureKind kind)
    : layout_(layout),
      program_(Program::compute(library, "stereo_luma.comp",
                                {{"OF_STREAM", kind == PictureKind::of_stream ? "1" : "0"},
                                 {"MOST_NOISE", std::to_string(max_noise)}})),
      left_(layout.luma_words() * 2 * 4, GL_DYNAMIC_COPY),
      right_(layout.luma_words() * 2 * 4, GL_DYNAMIC_COPY) {
    if (kind == PictureKind::single) return;
    for (std::optional<Memory>* memory : {&left_memory_, &right_memory_})
        memory->emplace(
            Memory{ExposurePass(library), Buffer(layout.luma_words() * 8, GL_DYNAMIC_COPY)});
}

void LumaPass::convert(const Texture& picture, const Buffer& luma, std::optional<Memory>& memory) {
    if (memory) memory->exposure.run(picture);
    program_.use();
    program_.input("picture", picture);
    program_.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
    program_.set("row_words", layout_.luma_row_words());
    luma.bind_storage(0);
    if (memory) {
        program_.set("has_state", has_state_ ? 1 : 0);
        memory->state.bind_storage(1);
        memory->exposure.gain().bind_storage(2);
    }
    program_.dispatch_over(layout_.luma_row_words(), layout_.height_px);
}

void LumaPass::run(PassProfiler& profiler, const Texture& left, const Texture& right) {
    const std::size_t pixels = layout_.pixels();
    // Of a stream, the state of both pictures and their last luma are read besides.
    const std::size_t bytes_per_pixel = left_memory_ ? 24 : 12;
    const double operations_per_pixel = left_memory_ ? 150 : 63;
    profiler.run("luma",
                 {pixels * bytes_per_pixel, static_cast<double>(pixels) * operations_per_pixel},
                 [&] {
                     convert(left, left_, left_memory_);
                     convert(right, right_, right_memory_);
                     has_state_ = true;
                     glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
                 });
}

}  // namespace vantage
