#include "rig_firmware/stereo/passes/result_pass.h"

namespace vantage {

ResultPass::ResultPass(const ShaderLibrary& library, const StereoLayout& layout)
    : layout_(layout),
      pass_(library, "stereo_result.frag"),
      result_(TextureFormat::r16ui, layout.width_px, layout.height_px),
      target_({&result_}) {}

const Texture& ResultPass::run(PassProfiler& profiler, const Buffer& disparity) {
    const std::size_t pixels = layout_.pixels();
    profiler.run("median", {pixels * 6, static_cast<double>(pixels) * 80}, [&] {
        Program& program = pass_.use();
        program.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
        program.set("stride", layout_.stride_px());
        disparity.bind_storage(0);
        pass_.draw(target_);
    });
    return result_;
}

}  // namespace vantage
