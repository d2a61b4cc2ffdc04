#include "calib_tools/stage/board_scale.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>

#include "calib_tools/stage/stage_graph.h"
#include "common/board/median.h"

namespace vantage {
namespace {

constexpr std::size_t fewest_instants = 3, fewest_corners = 6;

/// Nearest point of the two rays, in the left camera's frame.
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

/// Scale of the similarity that maps the described corners to the measured ones (Umeyama, 1991).
std::optional<double> scale_of(const StereoCalibration& rig, const BoardCorners& left,
                               const BoardCorners& right) {
    std::map<int, Eigen::Vector2d> seen_right;
    for (const BoardCorner& corner : right) seen_right[corner.id] = corner.pixel;
    std::vector<Eigen::Vector3d> measured, described;
    for (const BoardCorner& corner : left) {
        const auto other = seen_right.find(corner.id);
        if (other == seen_right.end()) continue;
        measured.push_back(triangulate(rig, corner.pixel, other->second));
        described.push_back(corner.board_m);
    }
    if (measured.size() < fewest_corners) return std::nullopt;
    using Points = Eigen::Matrix3Xd;
    const auto count = static_cast<Eigen::Index>(measured.size());
    const Points from = Eigen::Map<const Points>(described.front().data(), 3, count);
    const Points to = Eigen::Map<const Points>(measured.front().data(), 3, count);
    return Eigen::umeyama(from, to, true).topLeftCorner<3, 3>().col(0).norm();
}

}  // namespace

std::optional<double> board_scale(const std::vector<StageRig>& rigs, const BoardBody& body) {
    std::vector<double> scales;
    for (const StageRig& rig : rigs)
        for (const auto& [instant, left] : rig.left) {
            const auto right = rig.right.find(instant);
            if (right == rig.right.end()) continue;
            for (const int board : body.boards) {
                const auto wanted = [&](int each) { return each == board; };
                if (const auto scale = scale_of(rig.calibration, corners_of(left, wanted),
                                                corners_of(right->second, wanted)))
                    scales.push_back(*scale);
            }
        }
    if (scales.size() < fewest_instants) return std::nullopt;
    return median(scales);
}

}  // namespace vantage
