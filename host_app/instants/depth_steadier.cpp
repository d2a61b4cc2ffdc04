#include "host_app/instants/depth_steadier.h"

#include "host_app/instants/colour_steadier.h"
#include "host_app/instants/depth_spread.h"

namespace vantage {
namespace {

constexpr float softness = 0.002f;
/// A depth that wavers within its uncertainty is not moved any more after so long.
constexpr double held_from_s = 0.27;

/// The uniforms of depth_votes.glsl.
void set_votes(Program& program, const RigHistory& view, bool has_before) {
    program.set("softness", softness);
    program.set("spread", depth_spread(view.camera()));
    program.set("has_before", has_before ? 1.0f : 0.0f);
    program.set("most_instants", instants_of(DepthSteadier::mean_s, view.dt_s(),
                                             DepthSteadier::fewest, DepthSteadier::most));
    program.set("most_misses",
                instants_of(DepthSteadier::patience_s, view.dt_s(), DepthSteadier::least_patience,
                            DepthSteadier::most_patience));
}

}  // namespace

void DepthSteadier::steady(RigHistory& view) {
    const bool has_before = view.has_steady_before();
    // Asked for before anything is bound: making a texture binds it.
    const Framebuffer& target = view.next_steady_target();
    Program& program = pass_.use();
    program.set("depth_map", 0);
    program.set("steady_before", 1);
    program.set("picture_mean", 2);
    set_votes(program, view, has_before);
    view.depth().bind(0);
    (has_before ? view.steady_before() : view.depth()).bind(1);
    view.colour_mean().bind(2);
    pass_.draw(target);
    view.finish_steady_depth();
}

void DepthSteadier::settle(const RigHistory& view, RigSurface& surface) {
    const RigSurface* before = view.settled_before();
    const Framebuffer& target = surface.settled_target();
    Program& program = settle_.use();
    program.set("fresh", 0);
    program.set("steady", 1);
    program.set("before", 2);
    set_votes(program, view, before != nullptr);
    program.set("held_from", instants_of(held_from_s, view.dt_s(), 4, 16));
    surface.fresh_depth().bind(0);
    view.steady_depth().bind(1);
    (before ? before->depth() : surface.fresh_depth()).bind(2);
    settle_.draw(target);
    surface.finish_settled();
}

}  // namespace vantage
