#include "common/gl/two_stage_pass.h"

#include <utility>

namespace vantage {
namespace {

/// A depth between the two of two_stages.glsl.
constexpr float between = 0.5f;

ShaderDefines with_stage(ShaderDefines defines, const char* is_first) {
    defines.emplace_back("FIRST", is_first);
    return defines;
}

}  // namespace

TwoStagePass::TwoStagePass(const ShaderLibrary& library, const std::string& fragment,
                           const ShaderDefines& defines)
    : first_(library, fragment, with_stage(defines, "1")),
      second_(library, fragment, with_stage(defines, "0")) {}

void TwoStagePass::draw(const Framebuffer& target, const std::function<void(Program&)>& set) {
    set(first_.use());
    first_.draw_depth(target);
    set(second_.use());
    draw_left(second_, target);
}

void TwoStagePass::draw_left(FullscreenPass& second, const Framebuffer& target) {
    second.draw_where(target, GL_LESS, between, false);
}

}  // namespace vantage
