#include "rig_firmware/stereo/passes/feature_pass.h"

namespace vantage {

FeaturePass::FeaturePass(const ShaderLibrary& library, const StereoLayout& layout, double sigma)
    : layout_(layout),
      luma_program_(Program::compute(library, "stereo_luma.comp")),
      halve_program_(Program::compute(library, "stereo_halve.comp")),
      features_program_(Program::compute(library, "stereo_features.comp")),
      median_program_(Program::compute(library, "stereo_median_luma.comp")),
      permeability_program_(Program::compute(library, "stereo_permeability.comp")),
      left_luma_(layout.luma_words() * 4, GL_DYNAMIC_COPY),
      right_luma_(layout.luma_words() * 4, GL_DYNAMIC_COPY),
      guide_(layout.luma_words() * 4, GL_DYNAMIC_COPY),
      left_features_(layout.pixels() * 4, GL_DYNAMIC_COPY),
      right_features_(layout.pixels() * 4, GL_DYNAMIC_COPY),
      permeability_(layout.pixels() * 4, GL_DYNAMIC_COPY),
      table_(Buffer::of<std::uint32_t>(permeability_table(sigma))) {}

void FeaturePass::run(PassProfiler& profiler, const Texture& left, const Texture& right) {
    const std::size_t pixels = layout_.pixels();
    profiler.run("luma", {pixels * 10, static_cast<double>(pixels) * 16}, [&] {
        luma_program_.use();
        luma_program_.set("picture", 0);
        luma_program_.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
        luma_program_.set("row_words", layout_.luma_row_words());
        for (const auto& [texture, luma] :
             {std::pair(&left, &left_luma_), std::pair(&right, &right_luma_)}) {
            texture->bind(0);
            luma->bind_storage(0);
            luma_program_.dispatch_over(layout_.luma_row_words(), layout_.height_px);
        }
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    });
    derive(profiler);
}

void FeaturePass::run_halved(PassProfiler& profiler, const FeaturePass& fine) {
    const std::size_t pixels = layout_.pixels();
    profiler.run("halve", {pixels * 10, static_cast<double>(pixels) * 24}, [&] {
        halve_program_.use();
        halve_program_.set("fine_size",
                           Eigen::Vector2i(fine.layout_.width_px, fine.layout_.height_px));
        halve_program_.set("fine_row_words", fine.layout_.luma_row_words());
        halve_program_.set("coarse_size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
        halve_program_.set("coarse_row_words", layout_.luma_row_words());
        for (const auto& [from, to] : {std::pair(&fine.left_luma_, &left_luma_),
                                       std::pair(&fine.right_luma_, &right_luma_)}) {
            from->bind_storage(0);
            to->bind_storage(1);
            halve_program_.dispatch_over(layout_.luma_row_words(), layout_.height_px);
        }
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    });
    derive(profiler);
}

void FeaturePass::features(const Buffer& luma, const Buffer& words) {
    features_program_.use();
    features_program_.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
    features_program_.set("row_words", layout_.luma_row_words());
    features_program_.set("stride", layout_.stride_px());
    luma.bind_storage(0);
    words.bind_storage(1);
    features_program_.dispatch_over(layout_.stride_px() / 4, layout_.height_px);
}

void FeaturePass::derive(PassProfiler& profiler) {
    const std::size_t pixels = layout_.pixels();
    profiler.run("census and gradient", {pixels * 10, static_cast<double>(pixels) * 220}, [&] {
        features(left_luma_, left_features_);
        features(right_luma_, right_features_);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    });
    profiler.run("permeability", {pixels * 7, static_cast<double>(pixels) * 55}, [&] {
        median_program_.use();
        median_program_.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
        median_program_.set("row_words", layout_.luma_row_words());
        left_luma_.bind_storage(0);
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
    return left_luma_.bytes() + right_luma_.bytes() + guide_.bytes() + left_features_.bytes() +
           right_features_.bytes() + permeability_.bytes() + table_.bytes();
}

}  // namespace vantage
