#include "host_app/synthesis/layer_splitter.h"

#include "host_app/synthesis/depth_edges.h"

namespace vantage {
namespace {

FullscreenPass pass(const ShaderLibrary& library, const char* boundary, const char* depth) {
    return {library, "layer_split.frag", {{"BOUNDARY", boundary}, {"DEPTH", depth}}};
}

void draw(FullscreenPass& pass, const GpuView& source, const Framebuffer& target) {
    Program& program = pass.use();
    program.set("picture", 0);
    program.set("depth_map", 1);
    program.set("edge_ratio", depth_edge_ratio);
    source.colour().bind(0);
    source.depth().bind(1);
    pass.draw(target);
}

}  // namespace

LayerSplitter::LayerSplitter(const ShaderLibrary& library)
    : passes_{{{pass(library, "0", "1"), pass(library, "0", "0")},
               {pass(library, "1", "1"), pass(library, "1", "0")}}} {}

void LayerSplitter::split(const GpuView& source, GpuView& main, GpuView& boundary) {
    GpuView* const layers[] = {&main, &boundary};
    for (std::size_t i = 0; i < passes_.size(); ++i) {
        // Asked for before anything is bound: making a texture binds it.
        const Framebuffer& surface = layers[i]->surface_target();
        const Framebuffer& colour = layers[i]->trusted_colour_target();
        draw(passes_[i].depth, source, surface);
        draw(passes_[i].colour, source, colour);
        layers[i]->finish_trusted_colour();
    }
}

}  // namespace vantage
