#include "rig_firmware/stereo/disparity/support_pass.h"

#include <string>

#include "rig_firmware/stereo/volume/four_by_eight.h"

namespace vantage {

SupportPass::SupportPass(const ShaderLibrary& library, const StereoLayout& layout,
                         LaneMapping lanes)
    : layout_(layout),
      program_(four_by_eight::program(library,
                                      lanes == LaneMapping::disparities
                                          ? "supported_disparity_narrow.comp"
                                          : "supported_disparity.comp",
                                      {{"LEAST_VOTES", std::to_string(min_support)}})) {}

void SupportPass::run(PassProfiler& profiler, const Buffer& disparity, const Buffer& supported) {
    const std::size_t pixels = layout_.pixels();
    profiler.run("support", {pixels * 8, static_cast<double>(pixels) * 186}, [&] {
        disparity.bind_storage(0);
        supported.bind_storage(1);
        four_by_eight::run(program_, layout_);
    });
}

}  // namespace vantage
