#include "rig_firmware/stereo/volume/perm_pass.h"

#include <algorithm>
#include <string>

namespace vantage {

namespace {

/// Rows of a column, and columns of a row, between which sums are kept, see perm_columns.comp and
/// perm_rows.comp.
constexpr int group_rows = 4, group_columns = 4;

ShaderDefines column_defines(PermOutput output, int valid) {
    return {{"KEEP", output == PermOutput::costs ? "1" : "0"}, {"VALID", std::to_string(valid)}};
}

/// Walks columns with half a slab an invocation where that suits the GPU.
bool has_narrow_columns(PermOutput output, LaneMapping lanes) {
    return output == PermOutput::costs && lanes == LaneMapping::disparities;
}

Program column_program(const ShaderLibrary& library, PermOutput output, LaneMapping lanes,
                       int valid) {
    if (has_narrow_columns(output, lanes))
        return Program::compute(library, "perm_columns_narrow.comp");
    return Program::compute(library, "perm_columns.comp", column_defines(output, valid));
}

/// Along rows (0) or columns (1).
Program weight_program(const ShaderLibrary& library, int along, PermOutput output, int most_code) {
    const int most = output == PermOutput::costs ? most_code : 0;
    return Program::compute(library, "perm_weight.comp",
                            {{"ALONG", std::to_string(along)}, {"MOST", std::to_string(most)}});
}

/// Of a pixel in PermPass::weight().
std::size_t weight_bytes(PermOutput output) { return output == PermOutput::costs ? 2 : 4; }

ShaderDefines row_defines(PermCosts costs, LaneMapping lanes) {
    ShaderDefines defines = lane_defines(lanes);
    defines.emplace_back("GIVEN", costs == PermCosts::given ? "1" : "0");
    return defines;
}

}  // namespace

PermPass::PermPass(const ShaderLibrary& library, const StereoLayout& layout, int disparities,
                   PermOutput output, PermCosts costs, int most_code, LaneMapping lanes)
    : layout_(layout),
      disparities_(disparities),
      kind_(output),
      lanes_(lanes),
      rows_(Program::compute(library, "perm_rows.comp", row_defines(costs, lanes))),
      full_columns_(column_program(library, output, lanes, slab_disparities)),
      last_columns_(column_program(library, output, lanes, valid_in_last_slab(disparities))),
      weight_rows_(weight_program(library, 0, output, most_code)),
      weight_columns_(weight_program(library, 1, output, most_code)),
      volume_(layout.block_pixels() * slab_disparities, GL_DYNAMIC_COPY),
      down_(output == PermOutput::costs
                ? layout.block_pixels() * 2 * slab_disparities
                : std::max(StereoLayout{layout.width_px,
                                        (layout.height_px + group_rows - 1) / group_rows}
                                   .block_pixels() *
                               2 * slab_disparities,
                           layout.pixels() / group_columns * 2 * slab_disparities),
            GL_DYNAMIC_COPY),
      output_(layout.block_pixels() *
                  (output == PermOutput::costs
                       ? static_cast<std::size_t>(slabs_of(disparities) * slab_disparities)
                       : 8U),
              GL_DYNAMIC_COPY),
      weight_(layout.pixels() * weight_bytes(output), GL_DYNAMIC_COPY) {}

std::size_t PermPass::volume_bytes() const {
    return volume_.bytes() + down_.bytes() + (kind_ == PermOutput::costs ? output_.bytes() : 0U);
}

std::size_t PermPass::gpu_bytes() const {
    return volume_.bytes() + down_.bytes() + output_.bytes() + weight_.bytes();
}

void PermPass::run_line_pass(Program& program, int lines, int first_disparity) {
    program.use();
    program.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
    program.set("stride", layout_.stride_px());
    program.set("first_disparity", first_disparity);
    program.set("plane", static_cast<int>(layout_.block_pixels()));
    program.dispatch_over(lines, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void PermPass::run(PassProfiler& profiler, const FeaturePass& features,
                   const PermeabilityPass& permeability) {
    run(profiler, &features, permeability);
}

void PermPass::run(PassProfiler& profiler, const PermeabilityPass& permeability) {
    run(profiler, nullptr, permeability);
}

void PermPass::run(PassProfiler& profiler, const FeaturePass* features,
                   const PermeabilityPass& permeability) {
    const std::size_t pixels = layout_.pixels();
    const double evaluations = static_cast<double>(pixels) * slab_disparities;
    const int row_lanes =
        lanes_ == LaneMapping::disparities ? 2 * layout_.height_px : layout_.height_px;
    const int column_lanes =
        has_narrow_columns(kind_, lanes_) ? 2 * layout_.width_px : layout_.width_px;
    // A weight is written and read back twice along each direction, beside the permeabilities.
    const std::size_t weight_traffic = 4 + 7 * weight_bytes(kind_);
    profiler.run("weights", {pixels * weight_traffic, static_cast<double>(pixels) * 79}, [&] {
        permeability.along().bind_storage(0);
        weight_.bind_storage(1);
        run_line_pass(weight_rows_, layout_.height_px, 0);
        permeability.down().bind_storage(0);
        run_line_pass(weight_columns_, layout_.stride_px() / 4, 0);
    });
    // Per pixel of a slab: costs or features and permeabilities there and back, the sums, and the
    // marks written and read. Columns read the sums twice and leave costs or winners.
    const bool has_sparse_marks = lanes_ == LaneMapping::disparities;
    const std::size_t row_bytes = features ? 50 : has_sparse_marks ? 58 : 66;
    const std::size_t column_bytes = has_narrow_columns(kind_, lanes_) ? 60 : 68;
    for (int first = 0; first < disparities_; first += slab_disparities) {
        profiler.run("cost and rows", {pixels * row_bytes, evaluations * (features ? 32 : 15)},
                     [&] {
                         (features ? features->left_features() : output_).bind_storage(0);
                         if (features) features->right_features().bind_storage(1);
                         permeability.along().bind_storage(2);
                         volume_.bind_storage(3);
                         down_.bind_storage(4);
                         run_line_pass(rows_, row_lanes, first);
                     });
        profiler.run("columns and winners", {pixels * column_bytes, evaluations * 21}, [&] {
            permeability.down().bind_storage(0);
            volume_.bind_storage(1);
            down_.bind_storage(2);
            output_.bind_storage(3);
            weight_.bind_storage(4);
            const bool is_last = first + slab_disparities >= disparities_;
            run_line_pass(is_last ? last_columns_ : full_columns_, column_lanes, first);
        });
    }
}

}  // namespace vantage
