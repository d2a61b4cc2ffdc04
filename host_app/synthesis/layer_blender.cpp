#include "host_app/synthesis/layer_blender.h"

namespace vantage {

PixelOrigins origins_of(const DepthPicture& picture, const RigLayers& layers) {
    PixelOrigins origins{picture.shares(), {}};
    for (const DrawnLayer& layer : layers.used())
        origins.rigs.push_back(layer.surface->camera().name);
    return origins;
}

const Texture& LayerBlender::blend(const VirtualView& view, const Drawing& drawing,
                                   const BeforeFilling& before_filling, const Texture* depth_test) {
    blended_.resize({view.width_px, view.height_px}, notes_origins_, depth_test);
    if (layers_.used().empty())
        blended_.clear();
    else
        drawing(blended_, notes_origins_);
    origins_.reset();
    if (notes_origins_) origins_ = origins_of(blended_, layers_);
    const DepthPicture& picture = before_filling ? before_filling(blended_) : blended_;
    return filler_.fill(picture.colour(), picture.depth_m());
}

const Texture& LayerBlender::blend(const VirtualView& view, LayerPass& pass) {
    return blend(view, [&](const DepthPicture& into, bool notes_origins) {
        pass.use(layers_, notes_origins).draw(into.target());
    });
}

}  // namespace vantage
