#include "host_app/fusion/layer_blender.h"

namespace vantage {
namespace {

ShaderDefines defines(std::size_t layers, bool origins) {
    return {{"LAYERS", std::to_string(layers)}, {"ORIGINS", origins ? "1" : "0"}};
}

}  // namespace

LayerBlender::LayerBlender(const ShaderLibrary& library, std::string fragment, float softness,
                           std::size_t layers_a_rig)
    : library_(&library),
      fragment_(std::move(fragment)),
      softness_(softness),
      layers_(library),
      filler_(library) {
    // At once, for a driver that takes its time over them would halt a flight.
    for (std::size_t layers = layers_a_rig; layers <= RigLayers::max_layers; layers += layers_a_rig)
        plain_[layers - 1].emplace(library, fragment_, defines(layers, false));
}

FullscreenPass& LayerBlender::pass(std::size_t layers) {
    if (!notes_origins_) return *plain_[layers - 1];
    std::optional<FullscreenPass>& noting = noting_[layers - 1];
    if (!noting) noting.emplace(*library_, fragment_, defines(layers, true));
    return *noting;
}

const Texture& LayerBlender::blend(const VirtualView& view, const MoreInputs& more,
                                   const BeforeFilling& before_filling) {
    blended_.resize({view.width_px, view.height_px}, notes_origins_);
    if (layers_.used().empty()) {
        blended_.clear();
    } else {
        FullscreenPass& blending = pass(layers_.used().size());
        Program& program = blending.use();
        layers_.bind(program);
        program.set("softness", softness_);
        if (more) more(program, layers_.first_free_unit());
        blending.draw(blended_.target());
    }
    origins_.reset();
    if (notes_origins_) {
        origins_ = {blended_.shares(), {}};
        for (const GpuView* layer : layers_.used()) origins_->rigs.push_back(layer->camera().name);
    }
    const DepthPicture& picture = before_filling ? before_filling(blended_) : blended_;
    return filler_.fill(picture.colour(), picture.depth_m());
}

}  // namespace vantage
