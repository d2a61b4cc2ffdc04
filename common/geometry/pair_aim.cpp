#include "common/geometry/pair_aim.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/base/error.h"

namespace vantage {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double degrees = 180 / std::numbers::pi;

struct Span {
    double low, high;

    double width() const { return high - low; }
    double middle() const { return (low + high) / 2; }
    Span moved(double by) const { return {low + by, high + by}; }
    Span shared(const Span& other) const {
        return {std::max(low, other.low), std::min(high, other.high)};
    }
    Span spanned(const Span& other) const {
        return {std::min(low, other.low), std::max(high, other.high)};
    }
};

/// The image of one camera in the rectified orientation, at depth 1: the largest upright rectangle
/// inside it, and the smallest one around it.
struct RectifiedEdges {
    Span inner_x{-infinity, infinity}, inner_y{-infinity, infinity};
    Span outer_x{infinity, -infinity}, outer_y{infinity, -infinity};
};

RectifiedEdges edges_of(const CameraModel& camera, const Eigen::Matrix3d& rotation) {
    RectifiedEdges edges;
    const auto at = [&](double x, double y) {
        // The edges of a fisheye image may lie beside the rig.
        constexpr double least_z = 0.05;
        const Eigen::Vector3d ray = (rotation * camera.unproject({x, y})).normalized();
        const Eigen::Vector2d place = ray.head<2>() / std::max(ray.z(), least_z);
        edges.outer_x = edges.outer_x.spanned({place.x(), place.x()});
        edges.outer_y = edges.outer_y.spanned({place.y(), place.y()});
        return place;
    };
    constexpr int samples = 32;
    const double right = camera.width_px - 1, bottom = camera.height_px - 1;
    for (int i = 0; i <= samples; ++i) {
        const double share = static_cast<double>(i) / samples;
        edges.inner_x.low = std::max(edges.inner_x.low, at(0, share * bottom).x());
        edges.inner_x.high = std::min(edges.inner_x.high, at(right, share * bottom).x());
        edges.inner_y.low = std::max(edges.inner_y.low, at(share * right, 0).y());
        edges.inner_y.high = std::min(edges.inner_y.high, at(share * right, bottom).y());
    }
    return edges;
}

RectifiedEdges left_edges(const StereoCalibration& c) {
    return edges_of(c.left, c.rectified_from_left);
}

RectifiedEdges right_edges(const StereoCalibration& c) {
    return edges_of(c.right, c.rectified_from_right);
}

/// Direction of a camera's axis across the rectified image, at depth 1.
double axis_x(const Eigen::Matrix3d& rectified_from_camera) {
    return rectified_from_camera(0, 2) / rectified_from_camera(2, 2);
}

}  // namespace

double roll_between_deg(const Pose& right_from_left) {
    const Eigen::Matrix3d& r = right_from_left.linear();
    return std::atan2(r(1, 0) - r(0, 1), r(0, 0) + r(1, 1)) * degrees;
}

PairAim aim_of(const StereoCalibration& c) {
    PairAim aim;
    const double left = axis_x(c.rectified_from_left), right = axis_x(c.rectified_from_right);
    aim.toe_in_deg = (std::atan(left) - std::atan(right)) * degrees;
    if (left > right) aim.crossing_m = c.rectified.baseline_m / (left - right);
    aim.roll_deg = roll_between_deg(c.right_from_left);
    return aim;
}

double shared_view(const StereoCalibration& c, double distance_m) {
    const Span left = left_edges(c).inner_x;
    const Span right = right_edges(c).inner_x.moved(c.rectified.baseline_m / distance_m);
    return std::max(0.0, left.shared(right).width()) / std::max(left.width(), right.width());
}

double kept_view(const StereoCalibration& c, double distance_m) {
    const double shift = c.rectified.baseline_m / distance_m;
    const auto shown = [&](double cx_px) { return Span{-cx_px, c.rectified.width_px - 1 - cx_px}; };
    const double f = c.rectified.f_px;
    const Span seen = left_edges(c).inner_x.shared(right_edges(c).inner_x.moved(shift));
    const Span left = shown(c.rectified.cx_left_px), right = shown(c.rectified.cx_right_px);
    const Span kept = Span{f * seen.low, f * seen.high}.shared(left).shared(right.moved(f * shift));
    return seen.width() > 0 ? std::max(0.0, kept.width()) / (f * seen.width()) : 1;
}

double farthest_m(const RectifiedStereo& r) {
    return r.doffs_px() > 0 ? r.f_px * r.baseline_m / r.doffs_px() : infinity;
}

double nearest_m(const RectifiedStereo& r, int disparities) { return r.depth_m(disparities - 1); }

void compute_rectification_to(StereoCalibration& c, double alpha, double far_m) {
    compute_rectification(c, alpha);
    if (std::isinf(far_m)) return;
    const double shift = c.rectified.baseline_m / far_m;
    const RectifiedEdges left = left_edges(c), right = right_edges(c);
    const Span inner_x = left.inner_x.shared(right.inner_x.moved(shift));
    const Span inner_y = left.inner_y.shared(right.inner_y);
    const Span outer_x = left.outer_x.spanned(right.outer_x.moved(shift));
    const Span outer_y = left.outer_y.spanned(right.outer_y);
    if (!(inner_x.width() > 0) || !(inner_y.width() > 0))
        fail(
            "at {:.3g} m the cameras see nothing in common: they look {:.0f} degrees apart; state "
            "another distance with --far-m",
            far_m, aim_of(c).toe_in_deg);
    const double width = c.rectified.width_px - 1, height = c.rectified.height_px - 1;
    const double inner_f = std::max(width / inner_x.width(), height / inner_y.width());
    const double outer_f = std::min(width / outer_x.width(), height / outer_y.width());
    const auto between = [&](double inner, double outer) {
        return inner * (1 - alpha) + outer * alpha;
    };
    c.rectified.f_px = between(inner_f, outer_f);
    c.rectified.cx_left_px =
        width / 2 - c.rectified.f_px * between(inner_x.middle(), outer_x.middle());
    c.rectified.cx_right_px = c.rectified.cx_left_px + c.rectified.f_px * shift;
    c.rectified.cy_px = height / 2 - c.rectified.f_px * between(inner_y.middle(), outer_y.middle());
}

double suitable_far_m(const StereoCalibration& c) {
    constexpr double enough_shared = 0.7, crossings = 2;
    const PairAim aim = aim_of(c);
    if (aim.crossing_m <= 0 || shared_view(c, infinity) >= enough_shared) return infinity;
    return crossings * aim.crossing_m;
}

}  // namespace vantage
