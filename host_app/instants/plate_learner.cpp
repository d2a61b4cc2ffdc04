#include "host_app/instants/plate_learner.h"

#include "host_app/instants/depth_edges.h"

namespace vantage {

void PlateLearner::learn(RigHistory& view) {
    const std::shared_ptr<RigPlate> before = view.plate();
    const std::shared_ptr<RigPlate> next = pool_.take();
    // Asked for before anything is bound: making a texture binds it.
    const Framebuffer& target = next->picture(view.depth().size()).target();
    Program& program = learn_.use();
    program.set("depth_map", 0);
    program.set("picture", 1);
    program.set("plate_depth", 2);
    program.set("plate_colour", 3);
    program.set("edge_ratio", depth_edge_ratio);
    program.set("has_before", before ? 1.0f : 0.0f);
    view.depth().bind(0);
    view.colour().bind(1);
    (before ? before->picture().depth_m() : view.depth()).bind(2);
    (before ? before->picture().colour() : view.colour()).bind(3);
    learn_.draw(target);
    view.learn(next);
}

}  // namespace vantage
