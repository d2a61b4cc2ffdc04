#include "rig_firmware/stereo/disparity/result_pass.h"

namespace vantage {

ResultPass::ResultPass(const ShaderLibrary& library, const StereoLayout& layout,
                       bool with_confidence, DisparityForm form)
    : layout_(layout),
      form_(form),
      pass_(library, "stereo_result.frag",
            {{"CONFIDENCE", with_confidence ? "1" : "0"},
             {"HALVES", form == DisparityForm::halves ? "1" : "0"}}),
      result_(TextureFormat::r16ui, layout.width_px, layout.height_px),
      confidence_(with_confidence ? std::optional<Texture>(std::in_place, TextureFormat::r8ui,
                                                           layout.width_px, layout.height_px)
                                  : std::nullopt),
      target_(confidence_ ? Framebuffer({&result_, &*confidence_}) : Framebuffer({&result_})) {}

const Texture& ResultPass::run(PassProfiler& profiler, const Buffer& disparity) {
    const std::size_t pixels = layout_.pixels();
    const std::size_t bytes_per_pixel = form_ == DisparityForm::halves ? 4 : 6;
    profiler.run("result", {pixels * bytes_per_pixel, static_cast<double>(pixels) * 16}, [&] {
        Program& program = pass_.use();
        program.set("stride", layout_.stride_px());
        disparity.bind_storage(0);
        pass_.overwrite(target_);
    });
    return result_;
}

}  // namespace vantage
