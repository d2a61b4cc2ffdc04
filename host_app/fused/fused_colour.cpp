#include "host_app/fused/fused_colour.h"

#include "host_app/synthesis/rig_layers.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/views/tolerances.h"

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

namespace {

/// The kinds of pixels, stored as depths for the depth test; finished pixels lie below the first.
constexpr float inner_kind = 0.25f, empty_kind = 0.5f, edge_kind = 0.75f;

const char* const colour_shader = "fused_colour.frag";

/// Sets the alphas that mark places that no rig sees now.
void set_alphas(Program& program) {
    program.set("remembered_confidence", RigSurface::remembered_confidence);
    program.set("remembered_alpha", remembered_alpha / 255.0f);
}

}  // namespace

FusedColour::FusedColour(const ShaderLibrary& library)
    : kinds_pass_(library, "fused_kinds.frag"),
      first_rigs_(library, colour_shader, same_surface_share,
                  {{"EDGES", "0"}, {"FIRST_RIGS_ONLY", "1"}}, 1, 3),
      inner_(library, colour_shader, same_surface_share, {{"EDGES", "0"}}),
      edges_(library, colour_shader, same_surface_share, {{"EDGES", "1"}}),
      plain_(library, "fused_plain.frag", same_surface_share),
      on_baked_(library, "baked_colour.frag", same_surface_share) {}

const Texture& FusedColour::sort(const Texture& fused_depth) {
    kinds_.resize(fused_depth.size());
    Program& program = kinds_pass_.use();
    program.input("fused_depth", fused_depth);
    program.set("edge_ratio", 1 + view_edge_share);
    program.set("inner_kind", inner_kind);
    program.set("empty_kind", empty_kind);
    program.set("edge_kind", edge_kind);
    kinds_pass_.draw_depth(kinds_.target());
    return kinds_.texture();
}

FullscreenPass& FusedColour::use(LayerPass& pass, const RigLayers& layers,
                                 const Texture& fused_depth, bool notes_origins) {
    FullscreenPass& drawing = pass.use(layers, notes_origins);
    Program& program = drawing.use();
    program.input("fused_depth", fused_depth);
    program.set("edge_ratio", 1 + view_edge_share);
    set_alphas(program);
    return drawing;
}

void FusedColour::draw_plainly(const RigLayers& layers, const Texture& fused_depth,
                               const DepthPicture& into, bool notes_origins) {
    use(plain_, layers, fused_depth, notes_origins).draw(into.target());
}

void FusedColour::draw_on_baked(const RigLayers& layers, const DepthPicture& baked,
                                const DepthPicture& foreground, const DepthPicture& into,
                                bool notes_origins) {
    FullscreenPass& pass = on_baked_.use(layers, notes_origins);
    Program& program = pass.use();
    set_alphas(program);
    program.input("baked_colour", baked.colour());
    program.input("baked_depth", baked.depth_m());
    program.input("visibility", *baked.shares());
    program.input("foreground", foreground.colour());
    program.input("foreground_depth", foreground.depth_m());
    if (notes_origins) program.input("foreground_shares", *foreground.shares());
    pass.overwrite(into.target());
}

void FusedColour::draw(const RigLayers& layers, const Texture& fused_depth,
                       const DepthPicture& into, bool notes_origins) {
    const auto ready = [&](LayerPass& pass) -> FullscreenPass& {
        return use(pass, layers, fused_depth, notes_origins);
    };
    into.clear();
    ready(edges_).draw_where(into.target(), GL_LESS, 0.5f * (empty_kind + edge_kind), false);
    // Pixels that the first pass discards keep their kind; those that it draws are moved below the
    // second pass's threshold.
    const float done = 0.5f * (inner_kind + empty_kind), left = 0.5f * (inner_kind + done);
    if (layers.used().size() > 2)
        ready(first_rigs_).draw_where(into.target(), GL_GREATER, done, true);
    ready(inner_).draw_where(into.target(), GL_GREATER, left, false);
}

}  // namespace vantage
