#include "host_app/fusion/edge_trust.h"

namespace vantage {
namespace {

/// Depths that differ by more than this ratio lie on two surfaces.
constexpr float edge_ratio = 1.04f;

}  // namespace

void EdgeTrust::judge(GpuView& view) {
    // Asked for before anything is bound: making a texture binds it.
    const Framebuffer& target = view.trusted_colour_target();
    Program& program = pass_.use();
    program.set("picture", 0);
    program.set("depth_map", 1);
    program.set("edge_ratio", edge_ratio);
    view.colour().bind(0);
    view.surface().bind(1);
    pass_.draw(target);
    view.finish_trusted_colour();
}

}  // namespace vantage
