#include "host_app/refine/edge_confidence.h"

#include "host_app/views/depth_edges.h"

namespace vantage {

void EdgeConfidence::judge(RigSurface& surface) {
    surface.confidence().resize(surface.colour().size());
    Program& program = pass_.use();
    program.set("depth_map", 0);
    program.set("picture_size",
                Eigen::Vector2i(surface.colour().width_px(), surface.colour().height_px()));
    program.set("edge_ratio", depth_edge_ratio);
    surface.depth().bind(0);
    pass_.draw(surface.confidence().target());
}

}  // namespace vantage
