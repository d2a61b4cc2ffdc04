#include "host_app/gallery/layered_preparer.h"

#include "host_app/views/tolerances.h"

namespace vantage {
namespace {

FullscreenPass pass(const ShaderLibrary& library, const char* boundary, const char* depth) {
    return {library, "layer_split.frag", {{"BOUNDARY", boundary}, {"DEPTH", depth}}};
}

void draw(FullscreenPass& pass, const RigSurface& source, const Framebuffer& target) {
    Program& program = pass.use();
    program.input("picture", source.colour());
    program.input("depth_map", source.depth());
    program.set("edge_ratio", depth_edge_ratio);
    pass.draw(target);
}

}  // namespace

LayerSplitter::LayerSplitter(const ShaderLibrary& library)
    : passes_{{{pass(library, "0", "1"), pass(library, "0", "0")},
               {pass(library, "1", "1"), pass(library, "1", "0")}}} {}

void LayerSplitter::split(const RigSurface& source, RigSurface& main, RigSurface& boundary) {
    const std::array<RigSurface*, 2> layers{&main, &boundary};
    for (std::size_t i = 0; i < layers.size(); ++i) {
        // Before anything is bound: making a texture binds it.
        layers[i]->begin(source.camera(), source.colour().size(), source.depth().size(),
                         source.samples());
        draw(passes_[i].depth, source, layers[i]->depth_target());
        draw(passes_[i].colour, source, layers[i]->colour_target());
        layers[i]->finish_colour();
    }
}

void LayeredPreparer::take(std::span<const DepthView> views, double /*dt_s*/) {
    auto instant = std::make_shared<Instant>();
    for (const DepthView& view : views) {
        if (!view.has_depth() || view.colour.empty()) continue;
        const std::shared_ptr<RigSurface> source = surfaces_.take(), main = surfaces_.take(),
                                          boundary = surfaces_.take();
        source->upload(view, corrector_, uploader_);
        splitter_.split(*source, *main, *boundary);
        for (const auto& layer : {main, boundary}) triangles_.build(layer->grid(QuadGrid::fine));
        instant->rigs.push_back({main, boundary});
    }
    instant_ = std::move(instant);
}

std::shared_ptr<const Instant> LayeredPreparer::prepare(const VirtualView& /*target*/,
                                                        const PrepareLevel& /*level*/) {
    return instant_;
}

}  // namespace vantage
