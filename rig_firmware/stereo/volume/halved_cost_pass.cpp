#include "rig_firmware/stereo/volume/halved_cost_pass.h"

#include <string>

#include "rig_firmware/stereo/features/halve_pass.h"

namespace vantage {
namespace {

/// Of four pixels, that an invocation walks.
constexpr int steps = 16;

}  // namespace

HalvedCostPass::HalvedCostPass(const ShaderLibrary& library, const StereoLayout& fine,
                               int disparities, HalvedCostSamples samples, LaneMapping lanes)
    : fine_(fine),
      disparities_(halved_disparities(disparities)),
      samples_(samples),
      lanes_(lanes),
      program_(Program::compute(library,
                                lanes == LaneMapping::disparities ? "stereo_halved_cost_narrow.comp"
                                                                  : "stereo_halved_cost.comp",
                                {{"STEPS", std::to_string(steps)},
                                 {"BOTH", samples == HalvedCostSamples::two ? "1" : "0"}})) {}

void HalvedCostPass::run(PassProfiler& profiler, const FeaturePass& fine_features,
                         const Buffer& costs) {
    const StereoLayout coarse = halved(fine_);
    const int slabs = slabs_of(disparities_);
    const std::size_t slab_pixels = coarse.pixels() * static_cast<std::size_t>(slabs);
    const int samples = samples_ == HalvedCostSamples::two ? 2 : 1;
    profiler.run(
        "cost",
        {slab_pixels * 60, static_cast<double>(slab_pixels) * 16 * (samples == 2 ? 153 : 65)}, [&] {
            program_.use();
            program_.set("size", Eigen::Vector2i(coarse.width_px, coarse.height_px));
            program_.set("fine_size", Eigen::Vector2i(fine_.width_px, fine_.height_px));
            program_.set("fine_stride", fine_.stride_px());
            program_.set("plane", static_cast<int>(coarse.block_pixels()));
            fine_features.left_features().bind_storage(0);
            fine_features.right_features().bind_storage(1);
            costs.bind_storage(2);
            program_.dispatch_over(coarse.height_px,
                                   (coarse.width_px + 4 * steps - 1) / (4 * steps), slabs);
            glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        });
}

}  // namespace vantage
