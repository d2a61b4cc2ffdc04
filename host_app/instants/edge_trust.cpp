#include "host_app/instants/edge_trust.h"

#include "host_app/instants/depth_edges.h"

namespace vantage {

void EdgeTrust::judge(const Texture& picture, RigSurface& surface) {
    Program& program = pass_.use();
    program.set("picture", 0);
    program.set("depth_map", 1);
    program.set("edge_ratio", depth_edge_ratio);
    picture.bind(0);
    surface.depth().bind(1);
    pass_.draw(surface.colour_target());
    surface.finish_colour();
}

}  // namespace vantage
