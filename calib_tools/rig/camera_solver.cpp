#include "calib_tools/rig/camera_solver.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <opencv2/calib3d.hpp>

#include "calib_tools/bundle/lens_projection.h"
#include "common/base/error.h"
#include "common/board/median.h"
#include "common/geometry/opencv_bridge.h"

namespace vantage {
namespace {

/// Computes every board's pose from the camera alone. Returns false if one has no solution.
bool pose_boards(Bundle& bundle) {
    for (const BundleView& view : bundle.views) {
        const std::optional<Pose> pose =
            estimate_board_pose(bundle.cameras.front().model, view.corners);
        if (!pose) return false;
        bundle.boards[static_cast<std::size_t>(view.board)].world_from_board = *pose;
    }
    return true;
}

}  // namespace

std::vector<Pose> board_pose_candidates(const CameraModel& camera, const BoardCorners& corners) {
    if (corners.size() < 4) return {};
    std::vector<cv::Point3d> on_board;
    std::vector<cv::Point2d> rays;
    for (const BoardCorner& corner : corners) {
        on_board.emplace_back(corner.board_m.x(), corner.board_m.y(), corner.board_m.z());
        const Eigen::Vector3d ray = camera.unproject(corner.pixel);
        if (!ray.allFinite()) return {};
        rays.emplace_back(ray.x(), ray.y());
    }
    std::vector<Pose> poses;
    std::vector<cv::Mat> rotations, translations;
    try {
        cv::solvePnPGeneric(on_board, rays, cv::Matx33d::eye(), cv::noArray(), rotations,
                            translations, false, cv::SOLVEPNP_IPPE);
        for (std::size_t i = 0; i < rotations.size(); ++i) {
            cv::solvePnPRefineLM(on_board, rays, cv::Matx33d::eye(), cv::noArray(), rotations[i],
                                 translations[i]);
            cv::Matx33d matrix;
            cv::Rodrigues(rotations[i], matrix);
            Pose pose = Pose::Identity();
            pose.linear() = to_eigen(matrix);
            pose.translation() = to_eigen(cv::Vec3d(translations[i]));
            if (pose.matrix().allFinite() && pose.translation().z() > 0) poses.push_back(pose);
        }
    } catch (const cv::Exception&) {
        // OpenCV throws if all corners are in a line.
    }
    return poses;
}

std::optional<Pose> estimate_board_pose(const CameraModel& camera, const BoardCorners& corners) {
    const std::vector<Pose> poses = board_pose_candidates(camera, corners);
    if (poses.empty()) return std::nullopt;
    return poses.front();
}

std::optional<Bundle> solve_camera(const CameraViews& views, const LensFamily& family) {
    Bundle bundle;
    BundleCamera camera;
    camera.family = &family;
    camera.model.width_px = views.width_px;
    camera.model.height_px = views.height_px;
    camera.model.lens = family.lens;
    camera.model.distortion.assign(static_cast<std::size_t>(family.stored_coefficients), 0.0);
    camera.model.cx_px = 0.5 * (views.width_px - 1);
    camera.model.cy_px = 0.5 * (views.height_px - 1);
    bundle.cameras.push_back(camera);
    bundle.rigs.resize(1);
    bundle.boards.resize(views.instants.size());
    for (std::size_t i = 0; i < views.instants.size(); ++i)
        if (!views.instants[i].empty())
            bundle.views.push_back({0, static_cast<int>(i), views.instants[i]});

    std::optional<Bundle> best;
    double best_rms = 0;
    const double size_px = std::max(views.width_px, views.height_px);
    for (const double relative_focal_length : {0.4, 0.6, 0.85, 1.2, 1.8, 3.0}) {
        Bundle start = bundle;
        start.cameras[0].model.fx_px = start.cameras[0].model.fy_px =
            relative_focal_length * size_px;
        if (!pose_boards(start)) continue;
        // The start is inaccurate; a few steps with a wide loss show whether it converges.
        if (!solve_bundle(start, {.huber_px = 0.01 * size_px, .max_iterations = 15})) continue;
        const double rms = start.rms_px();
        if (std::isfinite(rms) && (!best || rms < best_rms)) {
            best = start;
            best_rms = rms;
        }
    }
    if (!best) return std::nullopt;
    // Computes the poses again with the better lens, since the mirrored pose of a small board can
    // persist.
    Bundle again = *best;
    if (pose_boards(again) && solve_robustly(again) && again.rms_px() <= best->rms_px())
        return again;
    if (!solve_robustly(*best)) return std::nullopt;
    return best;
}

double robust_sigma_px(const Bundle& bundle) {
    std::vector<double> sizes;
    for (const BundleView& view : bundle.views)
        for (const BoardCorner& corner : view.corners) {
            const Eigen::Vector2d r = bundle.residual_px(view, corner);
            sizes.push_back(std::abs(r.x()));
            sizes.push_back(std::abs(r.y()));
        }
    return 1.4826 * median(std::move(sizes));
}

bool solve_robustly(Bundle& bundle) {
    for (int pass = 0; pass < 2; ++pass) {
        const double sigma = std::max(0.01, robust_sigma_px(bundle));
        if (!solve_bundle(bundle, {.huber_px = 3 * sigma})) return false;
    }
    return true;
}

std::string implausibility(const CameraModel& camera) {
    const double size = std::max(camera.width_px, camera.height_px);
    for (const double f : {camera.fx_px, camera.fy_px})
        if (!(f > 0.15 * size && f < 20 * size))
            return fmt::format("a focal length of {:.0f} px", f);
    if (camera.cx_px < 0 || camera.cx_px > camera.width_px || camera.cy_px < 0 ||
        camera.cy_px > camera.height_px)
        return fmt::format("a principal point at ({:.0f}, {:.0f}), outside the picture",
                           camera.cx_px, camera.cy_px);
    // Along every ray from the principal point to the border, the distance from it must grow with
    // the angle; a radius that turns back would show one place twice.
    const std::array<double, lens_parameter_count> lens = [&] {
        std::array<double, lens_parameter_count> p{camera.fx_px, camera.fy_px, camera.cx_px,
                                                   camera.cy_px};
        std::copy(camera.distortion.begin(), camera.distortion.end(), p.begin() + 4);
        return p;
    }();
    constexpr int directions = 16, steps = 400;
    constexpr double max_slope = 3;  // tangent of 72 degrees off the axis
    std::vector<double> angles;
    for (int d = 0; d < directions; ++d) angles.push_back(2 * std::numbers::pi * d / directions);
    // The corners of the image are farthest from the axis.
    for (const double x : {-camera.cx_px, camera.width_px - 1 - camera.cx_px})
        for (const double y : {-camera.cy_px, camera.height_px - 1 - camera.cy_px})
            angles.push_back(std::atan2(y / camera.fy_px, x / camera.fx_px));
    for (const double angle : angles) {
        double last = 0;
        for (int s = 1; s <= steps; ++s) {
            const double radius = max_slope * s / steps;
            double pixel[2];
            project_through_lens(camera.lens, lens.data(), radius * std::cos(angle),
                                 radius * std::sin(angle), 1.0, pixel);
            const double out = std::hypot(pixel[0] - camera.cx_px, pixel[1] - camera.cy_px);
            if (!(out > last))
                return fmt::format(
                    "a distortion that folds the picture over {:.0f} px from its "
                    "centre",
                    last);
            last = out;
            if (pixel[0] < 0 || pixel[1] < 0 || pixel[0] > camera.width_px - 1 ||
                pixel[1] > camera.height_px - 1)
                break;
        }
    }
    return {};
}

}  // namespace vantage
