#include "rig_firmware/stereo/disparity/streak_pass.h"

#include <string>

namespace vantage {

StreakPass::StreakPass(const ShaderLibrary& library, const StereoLayout& layout, int disparities)
    : layout_(layout),
      program_(Program::compute(library, "row_streaks.comp",
                                {{"DISPARITIES", std::to_string(disparities)},
                                 {"MOST_ROWS", std::to_string(max_streak_rows)},
                                 {"MOST_GAIN", std::to_string(max_streak_gain) + "u"},
                                 {"LEAST_VALLEY", std::to_string(min_streak_valley) + "u"}})) {}

void StreakPass::run(PassProfiler& profiler, const Buffer& disparity, const Buffer& costs) {
    const std::size_t pixels = layout_.pixels();
    profiler.run("streaks", {pixels * 4, static_cast<double>(pixels) * 6}, [&] {
        program_.use();
        program_.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
        program_.set("stride", layout_.stride_px());
        program_.set("plane", static_cast<int>(layout_.block_pixels()));
        disparity.bind_storage(0);
        costs.bind_storage(1);
        program_.dispatch_over((layout_.width_px + 3) / 4, 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    });
}

}  // namespace vantage
