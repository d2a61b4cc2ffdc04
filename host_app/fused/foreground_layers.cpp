#include "host_app/fused/foreground_layers.h"

#include "common/gl/two_stage_pass.h"

namespace vantage {

ForegroundLayers::ForegroundLayers(const ShaderLibrary& library)
    : layers_(library, RigLayers::Depths::matted),
      find_(library, "foreground_show.frag", same_surface_share, {{"FIRST", "1"}}),
      show_(library, "foreground_show.frag", same_surface_share),
      show_plainly_(library, "foreground_show.frag", same_surface_share, {{"PLAIN", "1"}}) {}

const DepthPicture& ForegroundLayers::show(const Texture& picture, const Texture& depth_m,
                                           const Texture* shares,
                                           std::span<const DrawnLayer> performers,
                                           const VirtualView& target, bool is_plain) {
    constexpr std::size_t finely = 0;
    layers_.draw(performers, target, finely);
    open_.resize({target.width_px, target.height_px});
    shown_.resize({target.width_px, target.height_px}, shares != nullptr, &open_.texture());
    const auto ready = [&](LayerPass& pass) -> FullscreenPass& {
        FullscreenPass& drawing = pass.use(layers_, shares != nullptr);
        Program& program = drawing.use();
        int unit = layers_.first_free_unit();
        const auto bind = [&](const char* name, const Texture& texture) {
            texture.bind(unit);
            program.set(name, unit++);
        };
        bind("picture", picture);
        bind("background_depth", depth_m);
        if (shares) bind("background_shares", *shares);
        return drawing;
    };
    ready(find_).draw_depth(shown_.target());
    TwoStagePass::draw_left(ready(is_plain ? show_plainly_ : show_), shown_.target());
    return shown_;
}

}  // namespace vantage
