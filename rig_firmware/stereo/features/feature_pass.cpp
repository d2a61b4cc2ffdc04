#include "rig_firmware/stereo/features/feature_pass.h"

#include <string>

namespace vantage {
namespace {

/// Of the census, which slides its neighbourhood down the picture.
constexpr int rows_an_invocation = 16;

Program feature_program(const ShaderLibrary& library, FeatureRows rows, bool is_shifted) {
    return Program::compute(library, "stereo_features.comp",
                            {{"ROWS", std::to_string(rows_an_invocation)},
                             {"ROW_STEP", rows == FeatureRows::one_of_two ? "2" : "1"},
                             {"SHIFTED", is_shifted ? "1" : "0"}});
}

}  // namespace

FeaturePass::FeaturePass(const ShaderLibrary& library, const StereoLayout& layout, int disparities,
                         PictureKind kind, FeatureRows rows)
    : layout_(layout),
      disparities_(disparities),
      kind_(kind),
      rows_(rows),
      features_program_(feature_program(library, rows, false)),
      shifted_program_(feature_program(library, rows, true)),
      clear_program_(Program::compute(library, "stereo_clear.comp")),
      votes_program_(Program::compute(library, "row_shift_votes.comp")),
      left_features_(layout.pixels() * 4, GL_DYNAMIC_COPY),
      right_features_(layout.pixels() * 4, GL_DYNAMIC_COPY),
      votes_(8 * 4, GL_DYNAMIC_COPY) {
    if (rows == FeatureRows::one_of_two)
        all_rows_program_ = feature_program(library, FeatureRows::all, false);
}

void FeaturePass::features(Program& program, const Buffer& luma, const Buffer& words) {
    program.use();
    program.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
    program.set("row_words", layout_.luma_row_words());
    program.set("stride", layout_.stride_px());
    luma.bind_storage(0);
    words.bind_storage(1);
    program.dispatch_over(layout_.stride_px() / 4,
                          (layout_.height_px + rows_an_invocation - 1) / rows_an_invocation);
}

void FeaturePass::run(PassProfiler& profiler, const LumaPass& luma) {
    const std::size_t pixels = layout_.pixels();
    const bool compares = kind_ == PictureKind::single || frames_until_comparison_ == 0;
    // Rows are compared with their neighbours.
    const bool takes_all = compares || rows_ == FeatureRows::all;
    profiler.run(
        "census and gradient",
        {pixels * (takes_all ? 12 : 7), static_cast<double>(pixels) * (takes_all ? 149 : 80)}, [&] {
            Program& program =
                takes_all && all_rows_program_ ? *all_rows_program_ : features_program_;
            features(program, luma.left(), left_features_);
            features(program, luma.right(), right_features_);
            glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        });
    frames_until_comparison_ = (compares ? row_shift_period_frames : frames_until_comparison_) - 1;
    constexpr std::size_t sampling = 8 * 16;
    const std::size_t compared =
        compares ? pixels / sampling * static_cast<std::size_t>(disparities_) * 5 : 0;
    profiler.run("row shift", {compared * 4, static_cast<double>(compared) * 33}, [&] {
        if (compares) compare_rows();
        votes_.bind_storage(2);
        features(shifted_program_, luma.right(), right_features_);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    });
}

void FeaturePass::compare_rows() {
    clear_program_.use();
    clear_program_.set("count", 2);
    votes_.bind_storage(0);
    clear_program_.dispatch_over(2, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    votes_program_.use();
    votes_program_.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
    votes_program_.set("stride", layout_.stride_px());
    votes_program_.set("disparities", disparities_);
    left_features_.bind_storage(0);
    right_features_.bind_storage(1);
    votes_.bind_storage(2);
    votes_program_.dispatch_over((layout_.width_px + 7) / 8, (layout_.height_px + 15) / 16);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

std::size_t FeaturePass::gpu_bytes() const {
    return left_features_.bytes() + right_features_.bytes() + votes_.bytes();
}

}  // namespace vantage
