#include "host_app/synthesis/edge_trust.h"

#include "host_app/synthesis/depth_edges.h"

namespace vantage {

void EdgeTrust::judge(GpuView& view) {
    // Asked for before anything is bound: making a texture binds it.
    const Framebuffer& target = view.trusted_colour_target();
    Program& program = pass_.use();
    program.set("picture", 0);
    program.set("depth_map", 1);
    program.set("edge_ratio", depth_edge_ratio);
    view.colour().bind(0);
    view.surface().bind(1);
    pass_.draw(target);
    view.finish_trusted_colour();
}

}  // namespace vantage
