#include "rig_firmware/stereo/passes/perm_pass.h"

#include <algorithm>
#include <string>

#include "rig_firmware/stereo/passes/lane_mapping.h"

namespace vantage {

PermPass::PermPass(const ShaderLibrary& library, const StereoLayout& layout, int disparities)
    : layout_(layout),
      disparities_(disparities),
      rows_(Program::compute(library, "perm_rows.comp", lane_defines())),
      full_columns_(Program::compute(library, "perm_columns.comp")),
      last_columns_(
          Program::compute(library, "perm_columns.comp",
                           {{"VALID", std::to_string((disparities - 1) % slab_disparities + 1)}})),
      weight_rows_(Program::compute(library, "perm_weight.comp", {{"ALONG", "0"}})),
      weight_columns_(Program::compute(library, "perm_weight.comp", {{"ALONG", "1"}})),
      volume_(layout.block_pixels() * slab_disparities, GL_DYNAMIC_COPY),
      down_(layout.block_pixels() * 2 * slab_disparities, GL_DYNAMIC_COPY),
      winners_(layout.block_pixels() * 8, GL_DYNAMIC_COPY),
      weight_(layout.pixels() * 4, GL_DYNAMIC_COPY) {}

void PermPass::run_line_pass(Program& program, int lines, int first_disparity) {
    program.use();
    program.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
    program.set("stride", layout_.stride_px());
    program.set("first_disparity", first_disparity);
    program.dispatch_over(lines, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void PermPass::run(PassProfiler& profiler, const FeaturePass& features) {
    const std::size_t pixels = layout_.pixels();
    const double evaluations = static_cast<double>(pixels) * slab_disparities;
    const int row_lanes =
        lane_mapping() == LaneMapping::disparities ? 2 * layout_.height_px : layout_.height_px;
    for (int first = 0; first < disparities_; first += slab_disparities) {
        profiler.run("cost and rows", {pixels * (3 * 16 + 20), evaluations * 28}, [&] {
            features.left_features().bind_storage(0);
            features.right_features().bind_storage(1);
            features.permeability().bind_storage(2);
            volume_.bind_storage(3);
            run_line_pass(rows_, row_lanes, first);
        });
        profiler.run(
            "columns and winners", {pixels * (16 + 2 * 32 + 8 + 16), evaluations * 15}, [&] {
                features.permeability().bind_storage(0);
                volume_.bind_storage(1);
                down_.bind_storage(2);
                winners_.bind_storage(3);
                const bool is_last = first + slab_disparities >= disparities_;
                run_line_pass(is_last ? last_columns_ : full_columns_, layout_.width_px, first);
            });
    }
    profiler.run("weights", {pixels * 40, static_cast<double>(pixels) * 24}, [&] {
        features.permeability().bind_storage(0);
        weight_.bind_storage(1);
        run_line_pass(weight_rows_, layout_.height_px, 0);
        run_line_pass(weight_columns_, layout_.width_px, 0);
    });
}

}  // namespace vantage
