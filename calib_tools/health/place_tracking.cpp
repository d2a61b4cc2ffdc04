#include "calib_tools/health/place_tracking.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

#include "calib_tools/health/patch_search.h"
#include "common/image/image_file.h"

namespace vantage {
namespace {

constexpr int half_patch_px = 7, patch_px = 2 * half_patch_px + 1;
constexpr double good_match = 0.85;
constexpr double surface_share =
    0.04;  ///< a patch is on one surface if its depths differ by less than this share
constexpr double hidden_share = 0.1;
constexpr double fewest_known = 0.8;  ///< share of the patch's depths that are known
constexpr int reach_share = 32;       ///< share of the image width

/// Renders a's image as b sees the patch around (x, y), with b's depth. Empty if a part of it is
/// unknown, on another surface or outside a's image, or if a sees something nearer.
std::optional<GreyImage> patch_from(const OverlapView& a, const GreyImage& a_grey,
                                    const OverlapView& b, const Pose& a_from_b, int x, int y) {
    const float middle_m = b.depth_m(y, x);
    if (!(middle_m > 0)) return std::nullopt;
    const Eigen::Matrix3d ray_from_pixel = b.K.inverse();
    cv::Mat2f places(patch_px, patch_px);
    int known = 0;
    for (int dy = -half_patch_px; dy <= half_patch_px; ++dy)
        for (int dx = -half_patch_px; dx <= half_patch_px; ++dx) {
            float depth_m = b.depth_m(y + dy, x + dx);
            if (depth_m > 0) {
                if (std::abs(depth_m - middle_m) > surface_share * middle_m) return std::nullopt;
                ++known;
            } else {
                depth_m = middle_m;
            }
            const Eigen::Vector3d in_a =
                a_from_b * (depth_m * (ray_from_pixel * Eigen::Vector3d(x + dx, y + dy, 1)));
            if (!(in_a.z() > 0)) return std::nullopt;
            const Eigen::Vector3d pixel = a.K * in_a / in_a.z();
            if (pixel.x() < 1 || pixel.y() < 1 || pixel.x() > a_grey.cols - 2 ||
                pixel.y() > a_grey.rows - 2)
                return std::nullopt;
            if (dx == 0 && dy == 0) {
                const float seen_m = a.depth_m(static_cast<int>(std::lround(pixel.y())),
                                               static_cast<int>(std::lround(pixel.x())));
                if (seen_m > 0 && std::abs(seen_m - in_a.z()) > hidden_share * in_a.z())
                    return std::nullopt;
            }
            places(dy + half_patch_px, dx + half_patch_px) =
                cv::Vec2f(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
        }
    if (known < fewest_known * patch_px * patch_px) return std::nullopt;
    GreyImage patch;
    cv::remap(a_grey, patch, places, cv::noArray(), cv::INTER_LINEAR);
    return patch;
}

}  // namespace

std::vector<TrackedPlace> track_places(const OverlapView& a, const OverlapView& b, int most) {
    constexpr double quality = 0.02;
    const GreyImage a_grey = to_grey(a.colour), b_grey = to_grey(b.colour);
    std::vector<cv::Point2f> corners;
    cv::goodFeaturesToTrack(b_grey, corners, most, quality, half_patch_px);
    const Pose a_from_b = a.world_from_camera.inverse() * b.world_from_camera;
    const Eigen::Vector3d epipole = b.K * a_from_b.inverse().translation();
    const int reach = std::max(6, b_grey.cols / reach_share), margin = half_patch_px + reach;
    std::vector<TrackedPlace> tracked;
    for (const cv::Point2f& corner : corners) {
        const int x = static_cast<int>(std::lround(corner.x));
        const int y = static_cast<int>(std::lround(corner.y));
        if (x < margin || y < margin || x >= b_grey.cols - margin || y >= b_grey.rows - margin)
            continue;
        const std::optional<GreyImage> patch = patch_from(a, a_grey, b, a_from_b, x, y);
        if (!patch) continue;
        const cv::Rect area(x - margin, y - margin, 2 * margin + 1, 2 * margin + 1);
        const std::optional<Eigen::Vector2d> found = find_patch(b_grey(area), *patch, good_match);
        if (!found) continue;
        const Eigen::Vector2d pixel(x, y);
        const Eigen::Vector2d along = epipole.head<2>() - epipole.z() * pixel;
        if (!(along.norm() > 0)) continue;
        const Eigen::Vector2d across = Eigen::Vector2d(-along.y(), along.x()).normalized();
        tracked.push_back({pixel, (*found - Eigen::Vector2d(reach, reach)).dot(across)});
    }
    return tracked;
}

}  // namespace vantage
