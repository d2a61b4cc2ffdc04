#include "rig_firmware/stereo/disparity/left_right_pass.h"

namespace vantage {
namespace {

Program make_program(const ShaderLibrary& library, Valley valley, bool weighted) {
    return Program::compute(
        library, "left_right_check.comp",
        {{"WEIGHTED", weighted ? "1" : "0"}, {"FLAT_VALLEY", valley == Valley::flat ? "1" : "0"}});
}

}  // namespace

LeftRightPass::LeftRightPass(const ShaderLibrary& library, const StereoLayout& layout,
                             Valley valley)
    : layout_(layout),
      weighted_(make_program(library, valley, true)),
      unweighted_(make_program(library, valley, false)),
      claims_(layout.pixels() * 4, GL_DYNAMIC_COPY),
      disparity_(layout.pixels() * 4, GL_DYNAMIC_COPY) {}

void LeftRightPass::run(PassProfiler& profiler, const Buffer& winners, const Buffer* weight) {
    const std::size_t pixels = layout_.pixels();
    // Winners are read twice. Claims are cleared and staked within a search range, which stays in
    // the cache; later they are read.
    const std::size_t bytes_per_pixel = weight ? 32 : 28;
    profiler.run("left-right check", {pixels * bytes_per_pixel, static_cast<double>(pixels) * 188},
                 [&] {
                     Program& program = weight ? weighted_ : unweighted_;
                     program.use();
                     program.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
                     program.set("stride", layout_.stride_px());
                     winners.bind_storage(0);
                     if (weight) weight->bind_storage(1);
                     claims_.bind_storage(2);
                     disparity_.bind_storage(3);
                     program.dispatch_over(layout_.height_px, 1);
                     glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
                 });
}

}  // namespace vantage
