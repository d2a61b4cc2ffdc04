#include "rig_firmware/stereo/volume/perm_cost_pass.h"

namespace vantage {

PermCostPass::PermCostPass(const ShaderLibrary& library, const StereoLayout& layout,
                           int disparities)
    : layout_(layout),
      disparities_(disparities),
      program_(Program::compute(library, "perm_cost_narrow.comp")) {}

void PermCostPass::run(PassProfiler& profiler, const FeaturePass& features, const Buffer& costs) {
    const int slabs = slabs_of(disparities_);
    const std::size_t slab_pixels = layout_.pixels() * static_cast<std::size_t>(slabs);
    profiler.run("cost", {slab_pixels * 24, static_cast<double>(slab_pixels) * 16 * 25}, [&] {
        program_.use();
        program_.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
        program_.set("stride", layout_.stride_px());
        program_.set("plane", static_cast<int>(layout_.block_pixels()));
        features.left_features().bind_storage(0);
        features.right_features().bind_storage(1);
        costs.bind_storage(2);
        constexpr int halves_of_slab = 2;
        program_.dispatch_over((layout_.width_px + 3) / 4 * halves_of_slab, layout_.height_px,
                               slabs);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    });
}

}  // namespace vantage
