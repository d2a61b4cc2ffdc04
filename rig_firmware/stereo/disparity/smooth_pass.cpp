#include "rig_firmware/stereo/disparity/smooth_pass.h"

#include "rig_firmware/stereo/volume/four_by_eight.h"

namespace vantage {
namespace {

Program make_program(const ShaderLibrary& library, int along, int most_step, LaneMapping lanes) {
    ShaderDefines defines = lane_defines(lanes);
    defines.emplace_back("ALONG", std::to_string(along));
    defines.emplace_back("MOST_STEP", std::to_string(most_step));
    return four_by_eight::program(library, "disparity_smooth.comp", std::move(defines));
}

}  // namespace

SmoothPass::SmoothPass(const ShaderLibrary& library, const StereoLayout& layout, int most_step,
                       LaneMapping lanes)
    : layout_(layout),
      rows_(make_program(library, 0, most_step, lanes)),
      columns_(make_program(library, 1, most_step, lanes)),
      along_rows_(layout.pixels() * 4, GL_DYNAMIC_COPY) {}

void SmoothPass::run(PassProfiler& profiler, const Buffer& disparity) {
    const std::size_t pixels = layout_.pixels();
    const auto run_lines = [&](Program& program, const Buffer& from, const Buffer& to) {
        from.bind_storage(0);
        to.bind_storage(1);
        four_by_eight::run(program, layout_);
    };
    profiler.run("smooth", {pixels * 20, static_cast<double>(pixels) * 214}, [&] {
        run_lines(rows_, disparity, along_rows_);
        run_lines(columns_, along_rows_, disparity);
    });
}

}  // namespace vantage
