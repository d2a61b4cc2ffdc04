#include "rig_firmware/stereo/passes/result_pass.h"

#include <string>

namespace vantage {
namespace {

constexpr int rows_of_invocation = 8;

}  // namespace

ResultPass::ResultPass(const ShaderLibrary& library, const StereoLayout& layout,
                       bool with_confidence)
    : layout_(layout),
      median_(Program::compute(library, "disparity_median.comp",
                               {{"ROWS", std::to_string(rows_of_invocation)}})),
      medians_(layout.pixels() * 4, GL_DYNAMIC_COPY),
      pass_(library, "stereo_result.frag", {{"CONFIDENCE", with_confidence ? "1" : "0"}}),
      result_(TextureFormat::r16ui, layout.width_px, layout.height_px),
      confidence_(with_confidence ? std::optional<Texture>(std::in_place, TextureFormat::r8ui,
                                                           layout.width_px, layout.height_px)
                                  : std::nullopt),
      target_(confidence_ ? Framebuffer({&result_, &*confidence_}) : Framebuffer({&result_})) {}

const Texture& ResultPass::run(PassProfiler& profiler, const Buffer& disparity) {
    const std::size_t pixels = layout_.pixels();
    profiler.run("median", {pixels * 14, static_cast<double>(pixels) * 60}, [&] {
        median_.use();
        median_.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
        median_.set("stride", layout_.stride_px());
        disparity.bind_storage(0);
        medians_.bind_storage(1);
        median_.dispatch_over((layout_.width_px + 3) / 4,
                              (layout_.height_px + rows_of_invocation - 1) / rows_of_invocation);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        Program& program = pass_.use();
        program.set("stride", layout_.stride_px());
        medians_.bind_storage(0);
        pass_.draw(target_);
    });
    return result_;
}

}  // namespace vantage
