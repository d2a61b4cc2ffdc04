#include "host_app/pipeline/instant_preparer.h"

namespace vantage {

std::span<const PrepareLevel> prepare_levels() {
    static constexpr PrepareLevel levels[] = {
        {0, most_drawn_rigs},
        {1, 2},
        {2, 2, false},
        {3, 2, false, false, 3},
    };
    return levels;
}

void PlainPreparer::take(std::span<const DepthView> views, double /*dt_s*/) {
    auto instant = std::make_shared<Instant>();
    for (const DepthView& view : views) {
        if (view.colour.empty() || !(view.has_depth() || takes_all_)) continue;
        const std::shared_ptr<RigSurface> surface = surfaces_.take();
        surface->upload(view, corrector_, uploader_);
        for (const QuadGrid grid : {QuadGrid::fine, QuadGrid::coarse})
            triangles_.build(surface->grid(grid));
        instant->rigs.push_back({surface});
    }
    instant_ = std::move(instant);
}

std::shared_ptr<const Instant> PlainPreparer::prepare(const VirtualView& /*target*/,
                                                      const PrepareLevel& /*level*/) {
    return instant_;
}

}  // namespace vantage
