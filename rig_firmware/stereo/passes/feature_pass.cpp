#include "rig_firmware/stereo/passes/feature_pass.h"

#include <string>

namespace vantage {
namespace {

/// Of the census, which slides its neighbourhood down the picture.
constexpr int rows_an_invocation = 16;

}  // namespace

FeaturePass::FeaturePass(const ShaderLibrary& library, const StereoLayout& layout, double sigma)
    : layout_(layout),
      features_program_(Program::compute(library, "stereo_features.comp",
                                         {{"ROWS", std::to_string(rows_an_invocation)}})),
      median_program_(Program::compute(library, "stereo_median_luma.comp")),
      permeability_program_(Program::compute(library, "stereo_permeability.comp")),
      guide_(layout.luma_words() * 4, GL_DYNAMIC_COPY),
      left_features_(layout.pixels() * 4, GL_DYNAMIC_COPY),
      right_features_(layout.pixels() * 4, GL_DYNAMIC_COPY),
      permeability_(layout.pixels() * 4, GL_DYNAMIC_COPY),
      table_(Buffer::of<std::uint32_t>(permeability_table(sigma))) {}

void FeaturePass::features(const Buffer& luma, const Buffer& words) {
    features_program_.use();
    features_program_.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
    features_program_.set("row_words", layout_.luma_row_words());
    features_program_.set("stride", layout_.stride_px());
    luma.bind_storage(0);
    words.bind_storage(1);
    features_program_.dispatch_over(
        layout_.stride_px() / 4, (layout_.height_px + rows_an_invocation - 1) / rows_an_invocation);
}

void FeaturePass::run_words(PassProfiler& profiler, const LumaPass& luma) {
    const std::size_t pixels = layout_.pixels();
    profiler.run("census and gradient", {pixels * 10, static_cast<double>(pixels) * 220}, [&] {
        features(luma.left(), left_features_);
        features(luma.right(), right_features_);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    });
}

void FeaturePass::run(PassProfiler& profiler, const LumaPass& luma) {
    run_words(profiler, luma);
    const std::size_t pixels = layout_.pixels();
    profiler.run("permeability", {pixels * 7, static_cast<double>(pixels) * 55}, [&] {
        median_program_.use();
        median_program_.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
        median_program_.set("row_words", layout_.luma_row_words());
        luma.left().bind_storage(0);
        guide_.bind_storage(1);
        median_program_.dispatch_over(layout_.luma_row_words(), layout_.height_px);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        permeability_program_.use();
        permeability_program_.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
        permeability_program_.set("row_words", layout_.luma_row_words());
        permeability_program_.set("stride", layout_.stride_px());
        guide_.bind_storage(0);
        permeability_.bind_storage(1);
        table_.bind_storage(2);
        permeability_program_.dispatch_over(layout_.stride_px() / 4, layout_.height_px);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    });
}

std::size_t FeaturePass::gpu_bytes() const {
    return guide_.bytes() + left_features_.bytes() + right_features_.bytes() +
           permeability_.bytes() + table_.bytes();
}

}  // namespace vantage
