#include "host_app/synthesis/depth_steadier.h"

#include "host_app/synthesis/rig_layers.h"

namespace vantage {
namespace {

constexpr float softness = 0.002f;

/// The uniforms of depth_votes.glsl.
void set_votes(Program& program, const GpuView& view, bool has_before) {
    program.set("softness", softness);
    program.set("spread", depth_spread(view.camera()));
    program.set("has_before", has_before ? 1.0f : 0.0f);
}

}  // namespace

void DepthSteadier::steady(GpuView& view) {
    const bool has_before = view.has_steady_depth();
    // Asked for before anything is bound: making a texture binds it.
    const Framebuffer& target = view.next_steady_target();
    Program& program = pass_.use();
    program.set("depth_map", 0);
    program.set("steady_before", 1);
    program.set("picture_mean", 2);
    set_votes(program, view, has_before);
    view.depth().bind(0);
    view.steady_depth().bind(1);
    view.colour_mean().bind(2);
    pass_.draw(target);
    view.finish_steady_depth();
}

void DepthSteadier::settle(GpuView& view) {
    const bool has_before = view.has_settled_surface();
    const Framebuffer& target = view.next_settled_target();
    Program& program = settle_.use();
    program.set("fresh", 0);
    program.set("steady", 1);
    program.set("before", 2);
    set_votes(program, view, has_before);
    view.fresh_surface().bind(0);
    view.steady_depth().bind(1);
    view.surface().bind(2);
    settle_.draw(target);
    view.finish_settled_surface();
}

}  // namespace vantage
