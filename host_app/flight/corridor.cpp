#include "host_app/flight/corridor.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace vantage {
namespace {

/// Number of rays across and down, and the fall-off of their weight towards the corners.
constexpr int columns = 9, rows = 5;
constexpr double corner_falloff = 1.0;
/// Width of the smooth border of a rig's image, as a share of half the image.
constexpr double soft_border = 0.1;
/// Distances of the camera to a surface, as shares of the distance of the rig that sees it best.
/// The surface counts as blurred below the first and as sharp above the second.
constexpr double blurred_at = 0.1, sharp_at = 0.3;
/// Share of the picture's pixel density at which a rig covers a surface.
constexpr double min_density = 0.5;
/// Share of performers in a ray through their volume; the rest is background.
constexpr double performers_share = 0.5;
/// Angles between the camera and the nearest rig, seen from the stage, above which losses count as
/// `aside` and as `behind`.
constexpr double aside_rad = 35 * std::numbers::pi / 180,
                 far_side_rad = 120 * std::numbers::pi / 180;

double smooth_step(double from, double to, double x) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

/// Normals on the half of a ball that faces +z, each for the same area of its silhouette.
std::vector<Eigen::Vector3d> facing_normals() {
    constexpr int rings = 4;
    std::vector<Eigen::Vector3d> normals{Eigen::Vector3d::UnitZ()};
    const double all = 3 * rings * (rings - 1) + 1;
    for (int ring = 1; ring < rings; ++ring) {
        const int count = 6 * ring;
        const double inner = 3 * ring * (ring - 1) + 1, outer = inner + count;
        const double radius = std::sqrt(0.5 * (inner + outer) / all);
        for (int i = 0; i < count; ++i) {
            const double angle = 2 * std::numbers::pi * (i + 0.5 * (ring % 2)) / count;
            normals.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                                 std::sqrt(1 - radius * radius));
        }
    }
    return normals;
}

}  // namespace

const char* words_of(CoverageLoss loss) {
    switch (loss) {
        case CoverageLoss::aside:
            return "is turned away from the rigs";
        case CoverageLoss::too_near:
            return "is too near for the rigs' depth";
        case CoverageLoss::outside:
            return "is outside the rigs' pictures";
        case CoverageLoss::behind:
            break;
    }
    return "is seen from behind the stage, or is behind the rigs";
}

const char* key_of(CoverageLoss loss) {
    switch (loss) {
        case CoverageLoss::aside:
            return "aside";
        case CoverageLoss::too_near:
            return "too_near";
        case CoverageLoss::outside:
            return "outside";
        case CoverageLoss::behind:
            break;
    }
    return "behind";
}

const char* key_of(CorridorPlace place) {
    switch (place) {
        case CorridorPlace::inside:
            return "inside";
        case CorridorPlace::edge:
            return "edge";
        case CorridorPlace::beyond:
            break;
    }
    return "beyond";
}

Corridor::Corridor(std::vector<CorridorRig> rigs, const StageExtent& extent, double aspect)
    : rigs_(std::move(rigs)), extent_(extent), aspect_(aspect) {
    for (const CorridorRig& rig : rigs_)
        rigs_from_world_.push_back(rig.world_from_camera.inverse(Eigen::Isometry));
}

CorridorPlace Corridor::place_of(double share) {
    if (share >= edge) return CorridorPlace::inside;
    return share >= end ? CorridorPlace::edge : CorridorPlace::beyond;
}

double Corridor::outward_speed(double share) { return smooth_step(end, edge, share); }

double Corridor::in_picture(const CorridorRig& rig, const Eigen::Vector3d& in_rig) {
    if (in_rig.z() <= 0) return 0;
    const double across = std::abs(in_rig.x()) / (in_rig.z() * rig.half_width);
    const double down = std::abs(in_rig.y()) / (in_rig.z() * rig.half_height);
    return 1 - smooth_step(1 - 0.5 * soft_border, 1 + 0.5 * soft_border, std::max(across, down));
}

Coverage Corridor::of(const CameraState& camera) const {
    const double half_width = std::tan(0.5 * camera.field_of_view_rad);
    double sum = 0, weights = 0;
    std::array<double, 4> losses{};
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const double x = 2 * (column + 0.5) / columns - 1, y = 2 * (row + 0.5) / rows - 1;
            const Eigen::Vector3d in_camera(x * half_width, y * half_width * aspect_, 1);
            const RayCoverage ray =
                of_ray(camera.world_from_camera.translation(),
                       (camera.world_from_camera.linear() * in_camera).normalized());
            const double weight = std::exp(-corner_falloff * (x * x + y * y));
            weights += weight;
            sum += weight * ray.share;
            for (std::size_t i = 0; i < losses.size(); ++i) losses[i] += weight * ray.losses[i];
        }
    }
    // Far beside the rigs the background opposite is outside their images as well, but the angle is
    // the reason to report.
    const auto lost_to = [&](CoverageLoss loss) -> double& {
        return losses[static_cast<std::size_t>(loss)];
    };
    const double off_rad = off_the_rigs_rad(camera.world_from_camera.translation());
    if (off_rad > aside_rad)
        lost_to(CoverageLoss::aside) += std::exchange(lost_to(CoverageLoss::outside), 0);
    if (off_rad > far_side_rad)
        lost_to(CoverageLoss::behind) += std::exchange(lost_to(CoverageLoss::aside), 0);
    const auto most = std::max_element(losses.begin(), losses.end()) - losses.begin();
    return {std::clamp(sum / weights, 0.0, 1.0), static_cast<CoverageLoss>(most)};
}

double Corridor::off_the_rigs_rad(const Eigen::Vector3d& eye_m) const {
    double least_rad = std::numbers::pi;
    const Eigen::Vector3d to_eye = eye_m - extent_.centre_m;
    for (const CorridorRig& rig : rigs_) {
        const Eigen::Vector3d to_rig = rig.world_from_camera.translation() - extent_.centre_m;
        least_rad =
            std::min(least_rad, std::atan2(to_eye.cross(to_rig).norm(), to_eye.dot(to_rig)));
    }
    return least_rad;
}

Corridor::RayCoverage Corridor::of_ray(const Eigen::Vector3d& eye_m,
                                       const Eigen::Vector3d& direction) const {
    const Eigen::Vector3d to_centre = extent_.centre_m - eye_m;
    const double along_m = to_centre.dot(direction);
    const double miss_squared = std::max(to_centre.squaredNorm() - along_m * along_m, 0.0);
    const double radius = extent_.radius_m, background = extent_.background_m;
    // Length of the ray within the ball, and the share of the ray that shows the ball.
    const double half_chord_m = std::sqrt(std::max(radius * radius - miss_squared, 0.0));
    const double leaves_at_m = along_m + half_chord_m;
    const double body = (1 - smooth_step(0.8 * radius, 1.2 * radius, std::sqrt(miss_squared))) *
                        smooth_step(0, 0.5 * radius, leaves_at_m);
    // The background lies at the same distance beyond the middle for every ray.
    RayCoverage ray =
        of_background(eye_m + std::max(along_m + background, 0.2 * background) * direction);
    if (body <= 0) return ray;
    const double distance_m = std::max(along_m, 0.5 * leaves_at_m);
    const BodyCoverage met = of_body(eye_m + distance_m * direction, -direction, distance_m);
    const double of_performers = performers_share * body;
    ray.share += of_performers * (met.share - ray.share);
    for (std::size_t i = 0; i < ray.losses.size(); ++i)
        ray.losses[i] += of_performers * (met.losses[i] - ray.losses[i]);
    // A performer right in front of the camera hides everything else.
    const double blurred = body * (1 - met.sharp) * ray.share;
    ray.share -= blurred;
    ray.losses[static_cast<std::size_t>(CoverageLoss::too_near)] += blurred;
    return ray;
}

Corridor::BodyCoverage Corridor::of_body(const Eigen::Vector3d& point_m,
                                         const Eigen::Vector3d& to_eye, double distance_m) const {
    static const std::vector<Eigen::Vector3d> normals = facing_normals();
    struct Seer {
        Eigen::Vector3d direction;  ///< towards the rig; z points to the virtual camera
        double in_picture;
    };
    Eigen::Matrix3d upright;
    upright.col(2) = to_eye;
    upright.col(0) = to_eye.unitOrthogonal();
    upright.col(1) = to_eye.cross(upright.col(0));
    BodyCoverage covered;
    std::vector<Seer> seers;
    seers.reserve(rigs_.size());
    double best_seen = 0, best_cosine = -1, best_distance_m = 0;
    for (std::size_t i = 0; i < rigs_.size(); ++i) {
        const double seen = in_picture(rigs_[i], rigs_from_world_[i] * point_m);
        if (seen <= 0) continue;
        const Eigen::Vector3d to_rig = rigs_[i].world_from_camera.translation() - point_m;
        seers.push_back({upright.transpose() * to_rig.normalized(), seen});
        best_seen = std::max(best_seen, seen);
        if (seers.back().direction.z() > best_cosine) {
            best_cosine = seers.back().direction.z();
            best_distance_m = to_rig.norm();
        }
    }
    covered.losses[static_cast<std::size_t>(CoverageLoss::outside)] = 1 - best_seen;
    if (seers.empty()) return covered;
    double facing = 0;
    for (const Eigen::Vector3d& normal : normals) {
        double most = 0;
        for (const Seer& seer : seers)
            most = std::max(
                most, seer.in_picture * std::clamp(normal.dot(seer.direction) /
                                                       (min_density * std::max(normal.z(), 1e-3)),
                                                   0.0, 1.0));
        facing += most / static_cast<double>(normals.size());
    }
    covered.sharp = smooth_step(blurred_at, sharp_at, distance_m / best_distance_m);
    covered.share = facing;
    covered.losses[static_cast<std::size_t>(CoverageLoss::aside)] = best_seen - facing;
    return covered;
}

Corridor::RayCoverage Corridor::of_background(const Eigen::Vector3d& point_m) const {
    RayCoverage covered;
    bool is_any_ahead = false;
    for (std::size_t i = 0; i < rigs_.size(); ++i) {
        const Eigen::Vector3d in_rig = rigs_from_world_[i] * point_m;
        is_any_ahead |= in_rig.z() > 0;
        covered.share = std::max(covered.share, in_picture(rigs_[i], in_rig));
    }
    covered.losses[static_cast<std::size_t>(
        is_any_ahead ? CoverageLoss::outside : CoverageLoss::behind)] = 1 - covered.share;
    return covered;
}

}  // namespace vantage
