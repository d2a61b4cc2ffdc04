#include "host_app/synthesis/performer_layers.h"

namespace vantage {
namespace {

/// Surfaces of two rigs that are nearer to each other than this share of their depth are one.
constexpr float softness = 0.005f;

}  // namespace

PerformerLayers::PerformerLayers(const ShaderLibrary& library)
    : layers_(library),
      show_(library, "performer_show.frag", softness),
      show_plainly_(library, "performer_show.frag", softness, {{"PLAIN", "1"}}) {}

const DepthPicture& PerformerLayers::show(const Texture& picture, const Texture& depth_m,
                                          const Texture* shares,
                                          std::span<const DrawnLayer> performers,
                                          const VirtualView& target, bool is_plain) {
    constexpr std::size_t finely = 0;
    layers_.draw(performers, target, finely);
    shown_.resize({target.width_px, target.height_px}, shares != nullptr);
    FullscreenPass& showing = (is_plain ? show_plainly_ : show_).use(layers_, shares != nullptr);
    Program& program = showing.use();
    int unit = layers_.first_free_unit();
    const auto bind = [&](const char* name, const Texture& texture) {
        texture.bind(unit);
        program.set(name, unit++);
    };
    bind("picture", picture);
    bind("set_depth", depth_m);
    if (shares) bind("set_shares", *shares);
    showing.draw(shown_.target());
    return shown_;
}

}  // namespace vantage
