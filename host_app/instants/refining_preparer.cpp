#include "host_app/instants/refining_preparer.h"

#include "host_app/instants/rig_presence.h"
#include "host_app/instants/view_ranking.h"

namespace vantage {

RefiningPreparer::RefiningPreparer(const ShaderLibrary& library)
    : colour_steadier_(library),
      depth_steadier_(library),
      closer_(library),
      consensus_(library),
      edge_trust_(library),
      plates_(library),
      triangles_(library) {}

void RefiningPreparer::take(std::span<const DepthView> views, double dt_s) {
    for (RigHistory* rig : upload_with_fades(views, dt_s, rigs_)) {
        colour_steadier_.steady(*rig);
        depth_steadier_.steady(*rig);
        plates_.learn(*rig);
    }
}

void RefiningPreparer::forget() {
    for (const auto& rig : rigs_) rig->forget();
}

void RefiningPreparer::publish(RigHistory& rig, const PrepareLevel& level) {
    const std::shared_ptr<RigSurface> surface = surfaces_.take();
    surface->begin(rig.camera(), rig.colour().size(), rig.depth().size(), rig.samples());
    const Texture& bettered = level.refinement == PrepareLevel::Refinement::none
                                  ? rig.steady_depth()
                                  : consensus_.better(rig, rigs_, level.refinement);
    closer_.close(bettered, rig.steady_depth(), rig.colour(), surface->depth_target());
    depth_steadier_.settle(rig, *surface);
    edge_trust_.judge(rig, *surface);
    triangles_.build(surface->grid(QuadGrid::coarse));
    if (level.has_fine_grid) {
        triangles_.build(surface->grid(QuadGrid::fine));
        triangles_.build_rims(*surface);
    }
    surface->set_has_fine_grid(level.has_fine_grid);
    const int plate_indices = surface->triangle_indices(QuadGrid::coarse);
    if (rig.plate_instants() >= PlateLearner::confirmations && plate_indices > 0) {
        RigPlate& plate = *rig.plate();
        if (!plate.has_triangles())
            triangles_.build({plate.picture().depth_m(), plate.triangles_to_build(plate_indices),
                              rig.K_depth(), rig.camera().world_from_camera, QuadGrid::coarse});
        surface->set_plate(rig.plate());
    }
    rig.publish(surface, level.rank);
}

std::shared_ptr<const Instant> RefiningPreparer::prepare(const VirtualView& target,
                                                         const PrepareLevel& level) {
    auto instant = std::make_shared<Instant>();
    instant->level = level.rank;
    for (RigHistory* rig : most_useful(rigs_, target, level.rigs)) {
        if (!rig->prepared_rank() || *rig->prepared_rank() > level.rank) publish(*rig, level);
        instant->rigs.push_back({rig->surface(), nullptr, rig->presence()});
    }
    return instant;
}

}  // namespace vantage
