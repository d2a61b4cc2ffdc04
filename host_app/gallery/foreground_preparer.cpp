#include "host_app/gallery/foreground_preparer.h"

namespace vantage {
namespace {

/// Instants that a rig must have learnt before its background counts as known.
constexpr int known_from = 3;

}  // namespace

void ForegroundPreparer::copy(const Texture& source, const Framebuffer& target) {
    copy_.use().input("source", source);
    copy_.draw(target);
}

std::shared_ptr<RigSurface> ForegroundPreparer::surface_of(const RigHistory& rig,
                                                           const Texture& depth_m,
                                                           const Texture& colour) {
    std::shared_ptr<RigSurface> surface = surfaces_.take();
    surface->begin(rig.camera(), colour.size(), depth_m.size(), rig.samples());
    copy(depth_m, surface->depth_target());
    copy(colour, surface->colour_target());
    surface->finish_colour();
    return surface;
}

void ForegroundPreparer::take(std::span<const DepthView> views, double dt_s) {
    auto instant = std::make_shared<Instant>();
    auto performers = std::make_shared<ForegroundInstant>();
    for (RigHistory* rig : rigs_.upload(views, dt_s)) {
        sets_.learn(*rig);
        const std::shared_ptr<RigSurface> background =
            surface_of(*rig, rig->steady_depth(), rig->colour());
        triangles_.build(background->grid(QuadGrid::fine));
        const std::shared_ptr<ForegroundInstant::Matte> matte = mattes_.take();
        matte->share.resize(rig->matte().texture().size());
        copy(rig->matte().texture(), matte->share.target());
        performers->rigs.push_back({background, matte, rig->learnt_instants() >= known_from});
        instant->rigs.push_back({surface_of(*rig, rig->depth(), rig->fresh_colour())});
    }
    instant->extra = std::move(performers);
    instant_ = std::move(instant);
}

std::shared_ptr<const Instant> ForegroundPreparer::prepare(const VirtualView& /*target*/,
                                                           const PrepareLevel& /*level*/) {
    return instant_;
}

}  // namespace vantage
