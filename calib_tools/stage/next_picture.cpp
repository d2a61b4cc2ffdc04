#include "calib_tools/stage/next_picture.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <Eigen/Dense>
#include <Eigen/Geometry>

#include "common/base/error.h"

namespace vantage {
namespace {

constexpr double tilt_rad = 0.45;
/// Tried positions on the way from the rigs to the place both look at; near boards appear large.
constexpr double shares_of_way[] = {0.5, 0.7, 0.9};

/// Crossing of the rigs' optical axes: the middle between their nearest points.
std::optional<Eigen::Vector3d> crossing(const Pose& a, const Pose& b) {
    const Eigen::Vector3d axis_a = a.linear().col(2), axis_b = b.linear().col(2);
    Eigen::Matrix<double, 3, 2> axes;
    axes << axis_a, -axis_b;
    const Eigen::Vector2d along =
        axes.colPivHouseholderQr().solve(Eigen::Vector3d(b.translation() - a.translation()));
    if (!(along.minCoeff() > 0)) return std::nullopt;
    return 0.5 * (a.translation() + along[0] * axis_a + b.translation() + along[1] * axis_b);
}

/// Pose of a board whose front faces the eye, turned by tilt_rad.
Pose facing(const Eigen::Vector3d& middle, const Eigen::Vector3d& eye, const Eigen::Vector3d& down,
            const BoardPattern& pattern) {
    Pose pose = Pose::Identity();
    const Eigen::Vector3d z = (middle - eye).normalized(), x = down.cross(z).normalized();
    pose.linear() << x, z.cross(x), z;
    pose.rotate(Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d(1, 1, 0).normalized()));
    pose.translation() =
        middle - pose.linear() * (0.5 * pattern.corner_m(pattern.corner_count() - 1));
    return pose;
}

/// Corners of the board in the camera's image; empty unless the whole board is visible.
BoardCorners seen_by(const Bundle& bundle, int camera, const Pose& world_from_board,
                     const BoardPattern& pattern, int board) {
    const BundleCamera& c = bundle.cameras[static_cast<std::size_t>(camera)];
    const Pose camera_from_board =
        c.camera_from_rig * bundle.rigs[static_cast<std::size_t>(c.rig)].world_from_rig.inverse() *
        world_from_board;
    BoardCorners corners;
    for (int id = 0; id < pattern.corner_count(); ++id) {
        const auto pixel = c.model.project(camera_from_board * pattern.corner_m(id));
        if (!pixel || pixel->x() < 0 || pixel->y() < 0 || pixel->x() > c.model.width_px - 1 ||
            pixel->y() > c.model.height_px - 1)
            return {};
        corners.push_back({id, pattern.corner_m(id), *pixel, board});
    }
    return corners;
}

/// Bundle with one more board that both rigs see; empty if they cannot.
std::optional<Bundle> with_board_before(const Bundle& bundle, std::size_t a, std::size_t b,
                                        const BoardPattern& pattern, int board) {
    const Pose &rig_a = bundle.rigs[a].world_from_rig, &rig_b = bundle.rigs[b].world_from_rig;
    const std::optional<Eigen::Vector3d> aim = crossing(rig_a, rig_b);
    if (!aim) return std::nullopt;
    const Eigen::Vector3d eye = 0.5 * (rig_a.translation() + rig_b.translation());
    const Eigen::Vector3d down = rig_a.linear().col(1) + rig_b.linear().col(1);
    for (const double share : shares_of_way) {
        const Pose world_from_board =
            facing(eye + share * (*aim - eye), eye, down, pattern) *
            (board < static_cast<int>(bundle.faces.size())
                 ? bundle.faces[static_cast<std::size_t>(board)].board_from_face.inverse()
                 : Pose::Identity());
        Bundle more = bundle;
        more.boards.push_back({world_from_board, true});
        std::set<std::size_t> seeing;
        for (const std::size_t rig : {a, b})
            for (const std::size_t side : {0u, 1u}) {
                const int camera = static_cast<int>(2 * rig + side);
                BoardCorners corners = seen_by(bundle, camera, world_from_board, pattern, board);
                if (corners.empty()) continue;
                seeing.insert(rig);
                more.views.push_back(
                    {camera, static_cast<int>(more.boards.size()) - 1, std::move(corners)});
            }
        if (seeing.size() == 2) return more;
    }
    return std::nullopt;
}

}  // namespace

std::optional<NextPicture> most_helpful_picture(const Bundle& bundle, const BundleUncertainty& now,
                                                const BoardPattern& pattern, int board) {
    std::optional<NextPicture> best;
    double most = 0;
    for (std::size_t a = 0; a < bundle.rigs.size(); ++a)
        for (std::size_t b = a + 1; b < bundle.rigs.size(); ++b) {
            const std::optional<Bundle> more = with_board_before(bundle, a, b, pattern, board);
            if (!more) continue;
            const BundleUncertainty then = bundle_uncertainty(*more);
            // Simulated corners without residuals would lower the noise estimate of the measured
            // ones.
            const double as_noisy = now.residual_sigma_px / then.residual_sigma_px;
            NextPicture next{a, b, 0, 0, 0};
            double gain = 0;
            for (std::size_t rig = 0; rig < bundle.rigs.size(); ++rig) {
                const double sigma_now = now.rigs[rig].translation_m.norm();
                const double sigma_then = as_noisy * then.rigs[rig].translation_m.norm();
                gain += sigma_now * sigma_now - sigma_then * sigma_then;
                if (sigma_now - sigma_then > next.sigma_now_m - next.sigma_then_m) {
                    next.rig = rig;
                    next.sigma_now_m = sigma_now;
                    next.sigma_then_m = sigma_then;
                }
            }
            if (gain > most) {
                most = gain;
                best = next;
            }
        }
    return best;
}

}  // namespace vantage
