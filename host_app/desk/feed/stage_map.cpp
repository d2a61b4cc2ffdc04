#include "host_app/desk/feed/stage_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/LU>

#include "host_app/views/depth_view.h"
#include "host_app/views/projection.h"

namespace vantage {
namespace {

/// Calls `visit` with evenly spaced points of the surfaces that the rigs of a frame set see: the
/// position on the stage (metres) and the colour of the pixel. `max_of_a_rig` limits the number of
/// points of each rig.
template <class Visit>
void for_each_rig_point(const FrameSet& set, int max_of_a_rig, const Visit& visit) {
    for (const FrameSet::Slot& slot : set.slots) {
        if (!slot.frame) continue;
        const DepthView view = depth_view_of(*slot.frame);
        if (!view.has_depth() || view.colour.empty()) continue;
        const cv::Size size = view.depth_size();
        const double right = static_cast<double>(size.width) / view.colour.cols;
        const double down = static_cast<double>(size.height) / view.colour.rows;
        const Eigen::Matrix3d rays = scaled_intrinsics(view.K, right, down).inverse();
        const int step =
            std::max(1, static_cast<int>(
                            std::ceil(std::sqrt(static_cast<double>(size.area()) / max_of_a_rig))));
        for (int y = 0; y < size.height; y += step)
            for (int x = 0; x < size.width; x += step)
                if (const double z = view.depth_m_at(x, y); z > 0)
                    visit(Eigen::Vector3d(view.world_from_camera *
                                          (z * (rays * Eigen::Vector3d(x, y, 1)))),
                          view.colour(std::min(view.colour.rows - 1, static_cast<int>(y / down)),
                                      std::min(view.colour.cols - 1, static_cast<int>(x / right))));
    }
}

/// Number of points of the whole stage, so that the time to draw it does not depend on the rigs.
constexpr int max_stage_points = 4000;

/// Samples of each rig's depth map for picking and tracking.
constexpr int max_points_of_a_rig = 30'000;
/// Radius of a pick in widths of the picture, and the relative difference in depth up to which
/// points belong to one surface.
constexpr double radius_widths = 0.015, same_surface = 0.04;
constexpr std::size_t min_surface_points = 6;

/// The volume of one performer: a cylinder of this radius, above the floor and below a raised hand.
constexpr double performer_radius_m = 0.45, above_floor_m = 0.2, highest_m = 2.4;
/// Fewer points than this are no performer.
constexpr std::size_t min_performer_points = 40;
/// Iterations of the mean shift; a performer moves a few centimetres between frame sets.
constexpr int shifts = 4;

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

std::vector<DeskPlan::Point> stage_points(const FrameSet& set) {
    std::vector<DeskPlan::Point> points;
    if (set.present() == 0) return points;
    for_each_rig_point(set, max_stage_points / set.present(),
                       [&](const Eigen::Vector3d& at_m, const cv::Vec4b& rgba) {
                           points.push_back({at_m.cast<float>(), {rgba[0], rgba[1], rgba[2]}});
                       });
    return points;
}

std::optional<Eigen::Vector3d> surface_at(const FrameSet& set, const CameraState& camera,
                                          double aspect, const Eigen::Vector2d& place) {
    const Pose camera_from_world = camera.world_from_camera.inverse();
    const double width = 2 * std::tan(0.5 * camera.field_of_view_rad);
    const Eigen::Vector2d at(width * (place.x() - 0.5), width * aspect * (place.y() - 0.5));
    struct Seen {
        double depth_m;
        Eigen::Vector3d point_m;
    };
    std::vector<Seen> seen;
    for_each_rig_point(set, max_points_of_a_rig,
                       [&](const Eigen::Vector3d& point_m, const cv::Vec4b&) {
                           const Eigen::Vector3d there = camera_from_world * point_m;
                           if (there.z() <= 0) return;
                           if ((there.head<2>() / there.z() - at).norm() < radius_widths * width)
                               seen.push_back({there.z(), point_m});
                       });
    std::sort(seen.begin(), seen.end(),
              [](const Seen& a, const Seen& b) { return a.depth_m < b.depth_m; });
    // A tenth of the points must support the surface: wrong depths before it are fewer.
    const std::size_t enough = std::max(min_surface_points, seen.size() / 10);
    for (std::size_t first = 0; first + enough <= seen.size(); ++first) {
        if (seen[first + enough - 1].depth_m > (1 + same_surface) * seen[first].depth_m) continue;
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        double count = 0;
        for (std::size_t i = first;
             i < seen.size() && seen[i].depth_m <= (1 + same_surface) * seen[first].depth_m; ++i) {
            sum += seen[i].point_m;
            ++count;
        }
        return sum / count;
    }
    return std::nullopt;
}

std::optional<Eigen::Vector3d> foreground_near(const FrameSet& set,
                                               const Eigen::Vector3d& pivot_m) {
    std::vector<Eigen::Vector2d> around;
    const Eigen::Vector2d start(pivot_m.x(), pivot_m.z());
    for_each_rig_point(set, max_points_of_a_rig,
                       [&](const Eigen::Vector3d& point_m, const cv::Vec4b&) {
                           const Eigen::Vector2d ground(point_m.x(), point_m.z());
                           if (point_m.y() > above_floor_m && point_m.y() < highest_m &&
                               (ground - start).norm() < 2 * performer_radius_m)
                               around.push_back(ground);
                       });
    Eigen::Vector2d middle = start;
    for (int i = 0; i < shifts; ++i) {
        Eigen::Vector2d sum = Eigen::Vector2d::Zero();
        std::size_t count = 0;
        for (const Eigen::Vector2d& ground : around) {
            if ((ground - middle).norm() >= performer_radius_m) continue;
            sum += ground;
            ++count;
        }
        if (count < min_performer_points) return std::nullopt;
        middle = sum / static_cast<double>(count);
    }
    return Eigen::Vector3d(middle.x(), pivot_m.y(), middle.y());
}

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
