#include "host_app/synthesis/layer_pass.h"

#include <algorithm>

namespace vantage {

LayerPass::LayerPass(const ShaderLibrary& library, std::string fragment, float softness,
                     ShaderDefines more, std::size_t layers_per_rig, std::size_t min_layers)
    : library_(&library),
      fragment_(std::move(fragment)),
      softness_(softness),
      more_(std::move(more)) {
    // Compiled at once, since compiling during a flight would stall it.
    for (std::size_t layers = std::max(layers_per_rig, min_layers); layers <= RigLayers::max_layers;
         layers += layers_per_rig)
        plain_[layers - 1].emplace(library, fragment_, defines(layers, false));
}

ShaderDefines LayerPass::defines(std::size_t layers, bool origins) const {
    ShaderDefines all{{"LAYERS", std::to_string(layers)}, {"ORIGINS", origins ? "1" : "0"}};
    all.insert(all.end(), more_.begin(), more_.end());
    return all;
}

FullscreenPass& LayerPass::use(const RigLayers& layers, bool notes_origins) {
    const std::size_t count = layers.used().size();
    std::optional<FullscreenPass>& pass = (notes_origins ? noting_ : plain_)[count - 1];
    if (!pass) pass.emplace(*library_, fragment_, defines(count, notes_origins));
    Program& program = pass->use();
    layers.bind(program);
    program.set("softness", softness_);
    return *pass;
}

}  // namespace vantage
