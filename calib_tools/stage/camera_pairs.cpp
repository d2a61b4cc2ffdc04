#include "calib_tools/stage/camera_pairs.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>
#include <fmt/format.h>

#include "common/base/error.h"
#include "common/geometry/axis_crossing.h"

namespace vantage {
namespace {

constexpr int most_disparities = 256;  ///< of the matcher
/// The part of the stage that is nearest to a camera, as a share of the distance to its middle.
constexpr double nearest_share_of_stage = 0.6;
constexpr double degrees_of_radian = 180 / std::numbers::pi;

Eigen::Vector3d axis_of(const SingleCamera& camera) {
    return camera.world_from_camera.linear().col(2);
}

/// The first limit that the pair breaks; empty if it breaks none.
std::string broken_limit(const CameraPair& pair, const SingleCamera& left,
                         const SingleCamera& right, const PairLimits& limits) {
    const CameraModel &l = left.model, &r = right.model;
    if (l.width_px != r.width_px || l.height_px != r.height_px)
        return fmt::format("{}x{} and {}x{}: both cameras of a rig need pictures of one size",
                           l.width_px, l.height_px, r.width_px, r.height_px);
    if (l.lens != r.lens) return "one lens is fisheye and the other is not";
    if (pair.baseline_m < limits.least_baseline_m)
        return fmt::format("a baseline of {:.3f} m, below {} m", pair.baseline_m,
                           limits.least_baseline_m);
    if (pair.angle_deg > limits.most_angle_deg)
        return fmt::format("{:.1f} degrees between their axes, above {}", pair.angle_deg,
                           limits.most_angle_deg);
    if (const double share = pair.baseline_m / pair.distance_m; share > limits.most_baseline_share)
        return fmt::format(
            "a baseline of {:.2f} m at {:.2f} m from the stage, above {:.0f} % of it",
            pair.baseline_m, pair.distance_m, 100 * limits.most_baseline_share);
    const Eigen::Vector3d place =
        (left.world_from_camera.inverse() * right.world_from_camera).translation();
    if (std::abs(place.y()) > std::abs(place.x()))
        return fmt::format("they stand above each other ({:.2f} m down, {:.2f} m to the right)",
                           place.y(), place.x());
    if (std::abs(place.z()) > std::abs(place.x()))
        return fmt::format("they stand behind each other ({:.2f} m ahead, {:.2f} m to the right)",
                           place.z(), place.x());
    if (std::abs(pair.roll_deg) > limits.most_roll_deg)
        return fmt::format("{:.1f} degrees of roll, above {}", pair.roll_deg, limits.most_roll_deg);
    return {};
}

/// Rectifies in the largest of some sizes at which the matcher's disparities reach from the middle
/// of the stage to the part that is nearest to the cameras.
void rectify_for_matcher(CameraPair& pair, double alpha) {
    StereoCalibration& c = pair.calibration;
    const double far_m = suitable_far_m(c);
    double needed = 0;
    for (const int divisor : {1, 2, 3, 4}) {
        c.rectified.width_px = c.left.width_px / divisor;
        c.rectified.height_px = c.left.height_px / divisor;
        compute_rectification_to(c, alpha, far_m);
        needed = c.rectified.disparity_px(nearest_share_of_stage * pair.distance_m);
        if (needed < most_disparities) break;
    }
    if (needed >= most_disparities)
        pair.fault = fmt::format(
            "a disparity of {:.0f} px at {:.2f} m, above {}: they stand too far from each other",
            needed, nearest_share_of_stage * pair.distance_m, most_disparities);
    pair.disparities = std::clamp(static_cast<int>(needed / 16 + 1) * 16, 16, most_disparities);
}

}  // namespace

Eigen::Vector3d middle_of_stage(const std::vector<SingleCamera>& cameras) {
    AxisCrossing axes;
    for (const SingleCamera& camera : cameras) axes.add(camera.world_from_camera);
    const SingleCamera& first = cameras.front();
    constexpr double least_determinant = 1e-4, usual_m = 3;
    if (axes.sum().determinant() > least_determinant) {
        const Eigen::Vector3d middle = axes.point();
        if ((first.world_from_camera.inverse() * middle).z() > 0) return middle;
    }
    return first.world_from_camera * Eigen::Vector3d(0, 0, usual_m);
}

CameraPair pair_of(const std::vector<SingleCamera>& cameras, std::size_t a, std::size_t b,
                   const Eigen::Vector3d& middle, const PairLimits& limits, double alpha) {
    CameraPair pair{.left = a, .right = b};
    const auto place_x = [&](std::size_t left, std::size_t right) {
        return (cameras[left].world_from_camera.inverse() * cameras[right].world_from_camera)
            .translation()
            .x();
    };
    if (place_x(a, b) < 0) std::swap(pair.left, pair.right);
    const SingleCamera &left = cameras[pair.left], &right = cameras[pair.right];
    StereoCalibration& c = pair.calibration;
    c.left = left.model;
    c.right = right.model;
    c.right_from_left = right.world_from_camera.inverse() * left.world_from_camera;
    c.world_from_left = left.world_from_camera;
    pair.baseline_m = c.right_from_left.translation().norm();
    pair.angle_deg =
        std::acos(std::clamp(axis_of(left).dot(axis_of(right)), -1.0, 1.0)) * degrees_of_radian;
    pair.distance_m = (middle - left.world_from_camera.translation()).norm();
    pair.roll_deg = roll_between_deg(c.right_from_left);
    pair.fault = broken_limit(pair, left, right, limits);
    if (!pair.fault.empty()) return pair;
    try {
        compute_rectification(c, alpha);
        pair.overlap = shared_view(c, pair.distance_m);
        if (pair.overlap < limits.least_overlap) {
            pair.fault =
                fmt::format("{:.0f} % of their views in common at {:.2f} m, below {:.0f} %",
                            100 * pair.overlap, pair.distance_m, 100 * limits.least_overlap);
            return pair;
        }
        rectify_for_matcher(pair, alpha);
    } catch (const Error& error) {
        pair.fault = error.what();
    }
    return pair;
}

CameraPairs form_pairs(const std::vector<SingleCamera>& cameras, const PairLimits& limits,
                       double alpha) {
    const Eigen::Vector3d middle = middle_of_stage(cameras);
    std::vector<CameraPair> possible, refused;
    for (std::size_t a = 0; a < cameras.size(); ++a)
        for (std::size_t b = a + 1; b < cameras.size(); ++b) {
            CameraPair pair = pair_of(cameras, a, b, middle, limits, alpha);
            (pair.fault.empty() ? possible : refused).push_back(std::move(pair));
        }
    std::stable_sort(
        possible.begin(), possible.end(),
        [](const CameraPair& one, const CameraPair& other) { return one.overlap > other.overlap; });
    CameraPairs result;
    std::vector<bool> is_used(cameras.size());
    for (CameraPair& pair : possible) {
        if (is_used[pair.left] || is_used[pair.right]) continue;
        is_used[pair.left] = is_used[pair.right] = true;
        result.pairs.push_back(std::move(pair));
    }
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        if (is_used[i]) continue;
        const auto other = [&](const CameraPair& pair) {
            return pair.left == i ? pair.right : pair.left;
        };
        const auto is_of = [&](const CameraPair& pair) {
            return pair.left == i || pair.right == i;
        };
        std::string reason = "it is the only camera";
        // All partners within the limits are in other pairs, or the nearest camera is no partner.
        const auto taken = std::find_if(possible.begin(), possible.end(), is_of);
        if (taken != possible.end()) {
            reason = "every camera that it could pair with is in another pair";
        } else {
            const CameraPair* nearest = nullptr;
            for (const CameraPair& pair : refused)
                if (is_of(pair) && (!nearest || pair.baseline_m < nearest->baseline_m))
                    nearest = &pair;
            if (nearest)
                reason = fmt::format("no rig with {}, the nearest: {}",
                                     cameras[other(*nearest)].name, nearest->fault);
        }
        result.singles.push_back({i, reason});
    }
    return result;
}

}  // namespace vantage
