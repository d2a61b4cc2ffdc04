#include "host_app/session/corridor_fields.h"

#include <cmath>
#include <numbers>

namespace vantage {
namespace {

constexpr int sectors = 36, rings = 6;
constexpr std::size_t fields_at_once = 45;

bool is_like(const OrbitView& a, const OrbitView& b) {
    // Smaller changes are not visible in the map.
    constexpr double near_m = 0.05, near_rad = 0.03;
    return (a.pivot_m - b.pivot_m).norm() < near_m &&
           std::abs(a.elevation_rad - b.elevation_rad) < near_rad &&
           std::abs(a.field_of_view_rad - b.field_of_view_rad) < near_rad;
}

}  // namespace

void CorridorFields::begin(const std::shared_ptr<const Corridor>& corridor, const OrbitView& view,
                           double reach_m) {
    corridor_ = corridor;
    view_ = view;
    next_ = 0;
    coming_.clear();
    const double width_rad = 2 * std::numbers::pi / sectors;
    const double ring_m = reach_m / rings;
    // The innermost ring is the pivot itself, where no camera flies.
    for (int ring = 1; ring < rings; ++ring)
        for (int sector = 0; sector < sectors; ++sector)
            coming_.push_back({sector * width_rad, width_rad, ring * ring_m, (ring + 1) * ring_m});
}

void CorridorFields::follow(const std::shared_ptr<const Corridor>& corridor, const OrbitView& view,
                            double reach_m) {
    if (!corridor) return;
    if (corridor != corridor_ || (next_ == coming_.size() && !is_like(view, view_)))
        begin(corridor, view, reach_m);
    for (std::size_t i = 0; i < fields_at_once && next_ < coming_.size(); ++i, ++next_) {
        DeskPlan::Field& field = coming_[next_];
        OrbitView there = view_;
        there.azimuth_rad = field.azimuth_rad;
        there.distance_m = 0.5 * (field.from_m + field.to_m);
        field.place = Corridor::place_of(corridor_->of(there.camera()).share);
    }
    if (next_ == coming_.size()) {
        fields_ = coming_;
        shown_ = view_;
    }
}

}  // namespace vantage
