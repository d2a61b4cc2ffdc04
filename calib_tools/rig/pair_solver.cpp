#include "calib_tools/rig/pair_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "common/board/median.h"

namespace vantage {
namespace {

double angle_between(const Pose& a, const Pose& b) {
    return Eigen::AngleAxisd(Eigen::Matrix3d(a.linear().transpose() * b.linear())).angle();
}

std::map<int, const BundleView*> views_by_board(const Bundle& bundle, int camera) {
    std::map<int, const BundleView*> views;
    for (const BundleView& view : bundle.views)
        if (view.camera == camera) views[view.board] = &view;
    return views;
}

Eigen::Vector2d rectify_pixel(const CameraModel& camera, const Eigen::Matrix3d& rotation,
                              const RectifiedStereo& rectified, double cx_px,
                              const Eigen::Vector2d& pixel) {
    const Eigen::Vector3d ray = rotation * camera.unproject(pixel);
    return {rectified.f_px * ray.x() / ray.z() + cx_px,
            rectified.f_px * ray.y() / ray.z() + rectified.cy_px};
}

/// RMS error of the corners in one camera, predicted from the board's pose in another camera; for
/// the better of the two poses that a flat board may have there.
double predicted_rms_px(const CameraModel& from, const BoardCorners& seen_from,
                        const CameraModel& to, const BoardCorners& seen_to,
                        const Pose& to_from_from) {
    double best = std::numeric_limits<double>::max();
    for (const Pose& pose : board_pose_candidates(from, seen_from)) {
        double sum = 0;
        for (const BoardCorner& corner : seen_to) {
            const std::optional<Eigen::Vector2d> pixel =
                to.project(to_from_from * (pose * corner.board_m));
            const double miss = pixel ? (*pixel - corner.pixel).norm() : 1e4;
            sum += miss * miss;
        }
        best = std::min(best, std::sqrt(sum / static_cast<double>(seen_to.size())));
    }
    return best;
}

/// Corners as a camera rotated by 180 degrees would see them.
BoardCorners of_half_turned_picture(const BoardCorners& corners, const CameraModel& camera,
                                    bool numbered_anew) {
    BoardCorners turned = corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const BoardCorner& place = corners[numbered_anew ? corners.size() - 1 - i : i];
        turned[i].pixel = Eigen::Vector2d(camera.width_px - 1, camera.height_px - 1) - place.pixel;
    }
    return turned;
}

}  // namespace

PairStart middle_pose(const std::vector<Pose>& poses) {
    PairStart best;
    double best_cost = std::numeric_limits<double>::max();
    for (const Pose& candidate : poses) {
        std::vector<double> turns, ways;
        for (const Pose& pose : poses) {
            turns.push_back(angle_between(candidate, pose));
            ways.push_back((candidate.translation() - pose.translation()).norm());
        }
        const PairStart start{candidate, median(turns), median(ways)};
        const double cost = start.rotation_spread_rad +
                            start.translation_spread_m / (1e-9 + candidate.translation().norm());
        if (cost < best_cost) {
            best_cost = cost;
            best = start;
        }
    }
    return best;
}

std::optional<PairStart> start_pair(const Bundle& left, const Bundle& right) {
    const auto right_views = views_by_board(right, 0);
    std::vector<Pose> poses;
    for (const BundleView& view : left.views) {
        if (!right_views.contains(view.board)) continue;
        const auto board = static_cast<std::size_t>(view.board);
        poses.push_back(right.boards[board].world_from_board *
                        left.boards[board].world_from_board.inverse());
    }
    if (poses.empty()) return std::nullopt;
    return middle_pose(poses);
}

std::vector<OutlyingPair> outlying_pairs(const Bundle& left, const Bundle& right,
                                         const PairStart& start, bool looks_alike_half_turned) {
    const CameraModel &l = left.cameras.front().model, &r = right.cameras.front().model;
    // Pairs of one exposure are far below this with any lens; a rotated image, or one of another
    // exposure, is far above it.
    constexpr double limit_share = 0.04;
    const double limit_px = limit_share * l.width_px;
    const Pose left_from_right = start.right_from_left.inverse();
    const auto misfit = [&](const BoardCorners& in_left, const BoardCorners& in_right) {
        return std::min(predicted_rms_px(l, in_left, r, in_right, start.right_from_left),
                        predicted_rms_px(r, in_right, l, in_left, left_from_right));
    };
    const auto right_views = views_by_board(right, 0);
    std::vector<OutlyingPair> outlying;
    for (const auto& [board, left_view] : views_by_board(left, 0)) {
        const auto right_view = right_views.find(board);
        if (right_view == right_views.end()) continue;
        const BoardCorners &in_left = left_view->corners, &in_right = right_view->second->corners;
        OutlyingPair pair{board, OutlyingPair::Cause::other, misfit(in_left, in_right)};
        if (pair.misfit_px < limit_px) continue;
        const double right_turned =
            misfit(in_left, of_half_turned_picture(in_right, r, looks_alike_half_turned));
        const double left_turned =
            misfit(of_half_turned_picture(in_left, l, looks_alike_half_turned), in_right);
        if (std::min(left_turned, right_turned) < limit_px)
            pair.cause = right_turned < left_turned ? OutlyingPair::Cause::right_half_turned
                                                    : OutlyingPair::Cause::left_half_turned;
        outlying.push_back(pair);
    }
    return outlying;
}

std::optional<Bundle> solve_pair(const Bundle& left, const Bundle& right, const PairStart& start) {
    Bundle pair = left;
    BundleCamera camera = right.cameras.front();
    camera.camera_from_rig = start.right_from_left;
    camera.solve_pose = true;
    pair.cameras.push_back(camera);
    const auto left_views = views_by_board(left, 0);
    for (const BundleView& view : right.views) {
        const auto board = static_cast<std::size_t>(view.board);
        if (!left_views.contains(view.board))
            pair.boards[board].world_from_board =
                start.right_from_left.inverse() * right.boards[board].world_from_board;
        pair.views.push_back({1, view.board, view.corners});
    }
    if (!solve_robustly(pair)) return std::nullopt;
    return pair;
}

std::vector<double> row_differences_px(const StereoCalibration& calibration, const Bundle& pair) {
    const auto right_views = views_by_board(pair, 1);
    std::vector<double> differences;
    for (const auto& [board, left_view] : views_by_board(pair, 0)) {
        const auto right_view = right_views.find(board);
        if (right_view == right_views.end()) continue;
        std::map<int, Eigen::Vector2d> seen_right;
        for (const BoardCorner& corner : right_view->second->corners)
            seen_right[corner.id] = corner.pixel;
        const RectifiedStereo& r = calibration.rectified;
        for (const BoardCorner& corner : left_view->corners) {
            const auto other = seen_right.find(corner.id);
            if (other == seen_right.end()) continue;
            differences.push_back(rectify_pixel(calibration.left, calibration.rectified_from_left,
                                                r, r.cx_left_px, corner.pixel)
                                      .y() -
                                  rectify_pixel(calibration.right, calibration.rectified_from_right,
                                                r, r.cx_right_px, other->second)
                                      .y());
        }
    }
    return differences;
}

double root_mean_square(const std::vector<double>& values) {
    double sum = 0;
    for (const double v : values) sum += v * v;
    return values.empty() ? 0 : std::sqrt(sum / static_cast<double>(values.size()));
}

}  // namespace vantage
