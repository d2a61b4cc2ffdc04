#include "host_app/refine/edge_confidence.h"

#include "host_app/views/depth_edges.h"

namespace vantage {

void EdgeConfidence::judge(RigSurface& surface) {
    surface.confidence().resize(surface.colour().size());
    Program& program = pass_.use();
    program.input("depth_map", surface.depth());
    program.set("picture_size",
                Eigen::Vector2i(surface.colour().width_px(), surface.colour().height_px()));
    program.set("edge_ratio", depth_edge_ratio);
    pass_.draw(surface.confidence().target());
}

}  // namespace vantage
