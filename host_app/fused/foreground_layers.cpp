#include "host_app/fused/foreground_layers.h"

#include "common/gl/two_stage_pass.h"

namespace vantage {

ForegroundLayers::ForegroundLayers(const ShaderLibrary& library)
    : layers_(library, RigLayers::Depths::matted),
      find_(library, "foreground_show.frag", same_surface_share, {{"FIRST", "1"}}),
      show_(library, "foreground_show.frag", same_surface_share),
      show_plainly_(library, "foreground_show.frag", same_surface_share, {{"PLAIN", "1"}}),
      find_alone_(library, "foreground_show.frag", same_surface_share,
                  {{"FIRST", "1"}, {"ALONE", "1"}}),
      show_alone_(library, "foreground_show.frag", same_surface_share,
                  {{"PLAIN", "1"}, {"ALONE", "1"}}) {}

const DepthPicture& ForegroundLayers::show(const Texture& picture, const Texture& depth_m,
                                           const Texture* shares,
                                           std::span<const DrawnLayer> performers,
                                           const VirtualView& target, bool is_plain) {
    return show(find_, is_plain ? show_plainly_ : show_, &picture, depth_m, shares != nullptr,
                shares, performers, target);
}

const DepthPicture& ForegroundLayers::show_alone(const Texture& background_m, bool notes_shares,
                                                 std::span<const DrawnLayer> performers,
                                                 const VirtualView& target) {
    return show(find_alone_, show_alone_, nullptr, background_m, notes_shares, nullptr, performers,
                target);
}

const DepthPicture& ForegroundLayers::show(LayerPass& find, LayerPass& show, const Texture* picture,
                                           const Texture& depth_m, bool has_shares,
                                           const Texture* shares,
                                           std::span<const DrawnLayer> performers,
                                           const VirtualView& target) {
    constexpr std::size_t finely = 0;
    layers_.draw(performers, target, finely);
    open_.resize({target.width_px, target.height_px});
    shown_.resize({target.width_px, target.height_px}, has_shares, &open_.texture());
    const auto ready = [&](LayerPass& pass) -> FullscreenPass& {
        FullscreenPass& drawing = pass.use(layers_, has_shares);
        Program& program = drawing.use();
        program.input("background_depth", depth_m);
        if (picture) program.input("picture", *picture);
        if (shares) program.input("background_shares", *shares);
        return drawing;
    };
    ready(find).draw_depth(shown_.target());
    TwoStagePass::draw_left(ready(show), shown_.target());
    return shown_;
}

}  // namespace vantage
