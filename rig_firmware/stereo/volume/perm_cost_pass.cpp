#include "rig_firmware/stereo/volume/perm_cost_pass.h"

#include "rig_firmware/stereo/features/halve_pass.h"

namespace vantage {
namespace {

ShaderDefines cost_defines(CostRows rows, LaneMapping lanes) {
    ShaderDefines defines = lane_defines(lanes);
    defines.emplace_back("ROW_PAIRS", rows == CostRows::pairs ? "1" : "0");
    return defines;
}

}  // namespace

PermCostPass::PermCostPass(const ShaderLibrary& library, const StereoLayout& layout,
                           int disparities, CostRows rows, LaneMapping lanes, double max_operations)
    : layout_(layout),
      cost_layout_(rows == CostRows::pairs ? with_half_the_rows(layout) : layout),
      disparities_(disparities),
      rows_(rows),
      max_operations_(max_operations),
      program_(Program::compute(library, "perm_cost.comp", cost_defines(rows, lanes))) {}

void PermCostPass::run(PassProfiler& profiler, const FeaturePass& features, const Buffer& costs) {
    const int slabs = slabs_of(disparities_);
    const std::size_t slab_pixels = cost_layout_.pixels() * static_cast<std::size_t>(slabs);
    const int rows = rows_ == CostRows::pairs ? 2 : 1;
    // Words of both pictures are read and costs written; a second row reads costs as well.
    const std::size_t bytes = rows == 2 ? 64 : 24;
    const double operations = static_cast<double>(slab_pixels) * slab_disparities * 30 * rows;
    profiler.run("cost", {slab_pixels * bytes, operations}, [&] {
        program_.use();
        program_.set("size", Eigen::Vector2i(cost_layout_.width_px, cost_layout_.height_px));
        program_.set("stride", layout_.stride_px());
        program_.set("plane", static_cast<int>(cost_layout_.block_pixels()));
        features.left_features().bind_storage(0);
        features.right_features().bind_storage(1);
        costs.bind_storage(2);
        constexpr int halves_of_slab = 2;
        for (int row = 0; row < rows; ++row) {
            if (rows_ == CostRows::pairs) {
                program_.set("last_row", layout_.height_px - 1);
                program_.set("is_lower", row);
            }
            dispatch_in_parts(cost_layout_.height_px, 1, operations / rows, max_operations_,
                              [&](int first, int count) {
                                  program_.set("first_row", first);
                                  program_.dispatch_over(
                                      (layout_.width_px + 3) / 4 * halves_of_slab, count, slabs);
                              });
            glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        }
    });
}

}  // namespace vantage
