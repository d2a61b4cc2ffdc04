#include "host_app/fused/fused_depth.h"

#include "host_app/synthesis/layer_pass.h"

namespace vantage {

FusedDepth::FusedDepth(const ShaderLibrary& library) {
    for (std::size_t layers = 1; layers <= RigLayers::max_layers; ++layers)
        passes_.emplace_back(library, "fused_depth.frag",
                             ShaderDefines{{"LAYERS", std::to_string(layers)}});
}

const Texture& FusedDepth::find(const RigLayers& layers, cv::Size size) {
    depth_m_.resize(size);
    passes_[layers.used().size() - 1].draw(depth_m_.target(), [&](Program& program) {
        layers.bind(program);
        program.set("softness", same_surface_share);
    });
    return depth_m_.texture();
}

}  // namespace vantage
