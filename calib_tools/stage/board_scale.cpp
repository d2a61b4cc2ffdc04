#include "calib_tools/stage/board_scale.h"

#include <Eigen/Dense>

#include "calib_tools/board/median.h"

namespace vantage {
namespace {

constexpr std::size_t fewest_instants = 3, fewest_corners = 6;

/// Where the two rays come nearest to each other, in the left camera's frame.
Eigen::Vector3d triangulate(const StereoCalibration& rig, const Eigen::Vector2d& left_px,
                            const Eigen::Vector2d& right_px) {
    const Pose left_from_right = rig.right_from_left.inverse();
    const Eigen::Vector3d a = rig.left.unproject(left_px);
    const Eigen::Vector3d b = left_from_right.linear() * rig.right.unproject(right_px);
    Eigen::Matrix<double, 3, 2> rays;
    rays << a, -b;
    const Eigen::Vector2d along =
        rays.colPivHouseholderQr().solve(Eigen::Vector3d(left_from_right.translation()));
    return 0.5 * (along[0] * a + left_from_right.translation() + along[1] * b);
}

/// Mean distance of the corners from their middle, measured over described.
std::optional<double> scale_of(const StereoCalibration& rig, const BoardCorners& left,
                               const BoardCorners& right) {
    std::map<int, Eigen::Vector2d> seen_right;
    for (const BoardCorner& corner : right) seen_right[corner.id] = corner.pixel;
    std::vector<Eigen::Vector3d> measured, described;
    Eigen::Vector3d measured_middle = Eigen::Vector3d::Zero(),
                    described_middle = Eigen::Vector3d::Zero();
    for (const BoardCorner& corner : left) {
        const auto other = seen_right.find(corner.id);
        if (other == seen_right.end()) continue;
        measured.push_back(triangulate(rig, corner.pixel, other->second));
        described.push_back(corner.board_m);
        measured_middle += measured.back();
        described_middle += described.back();
    }
    if (measured.size() < fewest_corners) return std::nullopt;
    measured_middle /= static_cast<double>(measured.size());
    described_middle /= static_cast<double>(described.size());
    double measured_sum = 0, described_sum = 0;
    for (std::size_t i = 0; i < measured.size(); ++i) {
        measured_sum += (measured[i] - measured_middle).norm();
        described_sum += (described[i] - described_middle).norm();
    }
    return measured_sum / described_sum;
}

}  // namespace

std::optional<double> board_scale(const std::vector<StageRig>& rigs) {
    std::vector<double> scales;
    for (const StageRig& rig : rigs)
        for (const auto& [instant, left] : rig.left) {
            const auto right = rig.right.find(instant);
            if (right == rig.right.end()) continue;
            if (const auto scale = scale_of(rig.calibration, left, right->second))
                scales.push_back(*scale);
        }
    if (scales.size() < fewest_instants) return std::nullopt;
    return median(scales);
}

}  // namespace vantage
