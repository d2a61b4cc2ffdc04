#include "rig_firmware/stereo/passes/smooth_pass.h"

#include <string>

namespace vantage {
namespace {

constexpr int rows_of_invocation = 8;

Program make_program(const ShaderLibrary& library, int along) {
    return Program::compute(
        library, "disparity_smooth.comp",
        {{"ALONG", std::to_string(along)}, {"ROWS", std::to_string(rows_of_invocation)}});
}

}  // namespace

SmoothPass::SmoothPass(const ShaderLibrary& library, const StereoLayout& layout)
    : layout_(layout),
      rows_(make_program(library, 0)),
      columns_(make_program(library, 1)),
      along_rows_(layout.pixels() * 4, GL_DYNAMIC_COPY) {}

void SmoothPass::run(PassProfiler& profiler, const Buffer& disparity) {
    const std::size_t pixels = layout_.pixels();
    const auto run_lines = [&](Program& program, const Buffer& from, const Buffer& to) {
        program.use();
        program.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
        program.set("stride", layout_.stride_px());
        from.bind_storage(0);
        to.bind_storage(1);
        program.dispatch_over((layout_.width_px + 3) / 4,
                              (layout_.height_px + rows_of_invocation - 1) / rows_of_invocation);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    };
    profiler.run("smooth", {pixels * 20, static_cast<double>(pixels) * 80}, [&] {
        run_lines(rows_, disparity, along_rows_);
        run_lines(columns_, along_rows_, disparity);
    });
}

}  // namespace vantage
