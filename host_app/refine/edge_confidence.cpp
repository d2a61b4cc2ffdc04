#include "host_app/refine/edge_confidence.h"

namespace vantage {

void EdgeConfidence::judge(RigSurface& surface) {
    surface.confidence().resize(surface.colour().size());
    Program& program = pass_.use();
    program.input("depth_map", surface.depth());
    program.set("picture_size",
                Eigen::Vector2i(surface.colour().width_px(), surface.colour().height_px()));
    pass_.draw(surface.confidence().target());
}

}  // namespace vantage
