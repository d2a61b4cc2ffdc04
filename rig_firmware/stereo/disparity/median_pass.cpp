#include "rig_firmware/stereo/disparity/median_pass.h"

#include "rig_firmware/stereo/volume/four_by_eight.h"

namespace vantage {

MedianPass::MedianPass(const ShaderLibrary& library, const StereoLayout& layout)
    : layout_(layout), program_(four_by_eight::program(library, "disparity_median.comp")) {}

void MedianPass::run(PassProfiler& profiler, const Buffer& disparity, const Buffer& medians) {
    const std::size_t pixels = layout_.pixels();
    profiler.run("median", {pixels * 8, static_cast<double>(pixels) * 95}, [&] {
        disparity.bind_storage(0);
        medians.bind_storage(1);
        four_by_eight::run(program_, layout_);
    });
}

}  // namespace vantage
