#include "rig_firmware/stereo/volume/halved_cost_pass.h"

#include <string>

#include "rig_firmware/stereo/features/halve_pass.h"

namespace vantage {
namespace {

/// Of four pixels, that an invocation walks.
constexpr int steps = 16;
/// Rows of a workgroup.
constexpr int workgroup_rows = 16;

}  // namespace

HalvedCostPass::HalvedCostPass(const ShaderLibrary& library, const StereoLayout& fine,
                               int disparities, HalvedCostSamples samples, LaneMapping lanes,
                               double max_operations)
    : fine_(fine),
      disparities_(halved_disparities(disparities)),
      samples_(samples),
      runs_(samples == HalvedCostSamples::two && lanes == LaneMapping::disparities ? 2 : 1),
      max_operations_(max_operations),
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
    const double operations =
        static_cast<double>(slab_pixels) * slab_disparities * (samples == 2 ? 130 : 61);
    // A second run reads the costs of the first.
    const std::size_t bytes = runs_ == 2 ? 136 : 60;
    profiler.run("cost", {slab_pixels * bytes, operations}, [&] {
        program_.use();
        program_.set("size", Eigen::Vector2i(coarse.width_px, coarse.height_px));
        program_.set("fine_size", Eigen::Vector2i(fine_.width_px, fine_.height_px));
        program_.set("fine_stride", fine_.stride_px());
        program_.set("plane", static_cast<int>(coarse.block_pixels()));
        fine_features.left_features().bind_storage(0);
        fine_features.right_features().bind_storage(1);
        costs.bind_storage(2);
        for (int run = 0; run < runs_; ++run) {
            if (runs_ == 2) program_.set("is_lower", run);
            dispatch_in_parts(coarse.height_px, workgroup_rows, operations / runs_, max_operations_,
                              [&](int first, int count) {
                                  program_.set("first_row", first);
                                  program_.dispatch_over(
                                      count, (coarse.width_px + 4 * steps - 1) / (4 * steps),
                                      slabs);
                              });
            glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        }
    });
}

}  // namespace vantage
