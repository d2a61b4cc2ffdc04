#include "rig_firmware/stereo/disparity/row_fill_pass.h"

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

RowFillPass::RowFillPass(const ShaderLibrary& library, const StereoLayout& layout)
    : layout_(layout),
      support_(library, layout),
      program_(Program::compute(library, "row_fill.comp")) {}

void RowFillPass::run(PassProfiler& profiler, const Buffer& disparity, const Buffer& filled) {
    support_.run(profiler, disparity, filled);
    const std::size_t pixels = layout_.pixels();
    profiler.run("fill", {pixels * 20, static_cast<double>(pixels) * 29}, [&] {
        program_.use();
        program_.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
        program_.set("stride", layout_.stride_px());
        disparity.bind_storage(0);
        filled.bind_storage(1);
        program_.dispatch_over(layout_.height_px, 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    });
}

}  // namespace vantage
