#include "calib_tools/bundle/corner_cost.h"

#include <array>
#include <cmath>
#include <optional>

#include <ceres/jet.h>

#include "calib_tools/bundle/lens_projection.h"

namespace vantage {
namespace {

constexpr int lens_block = 0, camera_block = 1, rig_block = 2, board_block = 3, face_block = 4;

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
    Eigen::Matrix3d m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
}

/// The right Jacobian of SO(3): exp(w + dw) = exp(w) exp(right_jacobian(w) dw).
Eigen::Matrix3d right_jacobian(const Eigen::Vector3d& w) {
    constexpr double small = 1e-4;  // below it the series is more exact than the closed form
    const double angle = w.norm(), square = angle * angle;
    const bool is_small = angle < small;
    const double a = is_small ? 0.5 - square / 24 : (1 - std::cos(angle)) / square;
    const double b =
        is_small ? 1.0 / 6 - square / 120 : (angle - std::sin(angle)) / (square * angle);
    const Eigen::Matrix3d c = cross_matrix(w);
    return Eigen::Matrix3d::Identity() - a * c + b * c * c;
}

/// A pose with its change, as a function of the change and of the point that it moves.
class ChangedPose {
  public:
    ChangedPose(const Pose& base, const double* change)
        : base_(base),
          w_(change[0], change[1], change[2]),
          turn_(rotation_of(w_)),
          place_(base.translation() + Eigen::Vector3d(change[3], change[4], change[5])) {}

    Eigen::Vector3d operator()(const Eigen::Vector3d& point) const {
        return turn_ * (base_.linear() * point) + place_;
    }
    Eigen::Vector3d inverse(const Eigen::Vector3d& point) const {
        return base_.linear().transpose() * (turn_.transpose() * (point - place_));
    }
    /// Derivative of the moved point by the point; that of inverse() is its transpose.
    Eigen::Matrix3d by_point() const { return turn_ * base_.linear(); }
    using ByChange = Eigen::Matrix<double, 3, 6>;
    ByChange by_change(const Eigen::Vector3d& point) const {
        ByChange by;
        by << -turn_ * cross_matrix(base_.linear() * point) * right_jacobian(w_),
            Eigen::Matrix3d::Identity();
        return by;
    }
    ByChange inverse_by_change(const Eigen::Vector3d& point) const {
        const Eigen::Vector3d turned_back = turn_.transpose() * (point - place_);
        ByChange by;
        by << base_.linear().transpose() * cross_matrix(turned_back) * right_jacobian(w_),
            -by_point().transpose();
        return by;
    }

  private:
    const Pose& base_;
    Eigen::Vector3d w_;
    Eigen::Matrix3d turn_;
    Eigen::Vector3d place_;
};

}  // namespace

Eigen::Matrix3d rotation_of(const Eigen::Vector3d& w) {
    const double angle = w.norm();
    if (angle == 0) return Eigen::Matrix3d::Identity();
    return Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
}

CornerCost::CornerCost(const Bundle& bundle, const BundleView& view, const BoardCorner& corner)
    : camera_(bundle.cameras[static_cast<std::size_t>(view.camera)]),
      world_from_rig_(bundle.rigs[static_cast<std::size_t>(camera_.rig)].world_from_rig),
      world_from_board_(bundle.boards[static_cast<std::size_t>(view.board)].world_from_board),
      board_from_face_(bundle.faces.empty()
                           ? nullptr
                           : &bundle.faces[static_cast<std::size_t>(corner.board)].board_from_face),
      corner_m_(corner.board_m),
      pixel_(corner.pixel) {
    set_num_residuals(2);
    *mutable_parameter_block_sizes() = {lens_parameter_count, 6, 6, 6};
    if (board_from_face_) mutable_parameter_block_sizes()->push_back(6);
}

bool CornerCost::Evaluate(double const* const* parameters, double* residual,
                          double** jacobians) const {
    const ChangedPose camera(camera_.camera_from_rig, parameters[camera_block]),
        rig(world_from_rig_, parameters[rig_block]),
        board(world_from_board_, parameters[board_block]);
    std::optional<ChangedPose> face;
    if (board_from_face_) face.emplace(*board_from_face_, parameters[face_block]);
    const Eigen::Vector3d on_board = face ? (*face)(corner_m_) : corner_m_;
    const Eigen::Vector3d in_world = board(on_board), in_rig = rig.inverse(in_world),
                          p = camera(in_rig);
    if (!(p.z() > 1e-9)) return false;
    const double* lens = parameters[lens_block];
    Eigen::Map<Eigen::Vector2d> r(residual);
    if (!jacobians) {
        project_through_lens(camera_.model.lens, lens, p.x(), p.y(), p.z(), residual);
        r -= pixel_;
        return true;
    }

    constexpr int point = lens_parameter_count;
    using Jet = ceres::Jet<double, lens_parameter_count + 3>;
    std::array<Jet, lens_parameter_count> lens_jets;
    for (int i = 0; i < lens_parameter_count; ++i)
        lens_jets[static_cast<std::size_t>(i)] = Jet(lens[i], i);
    std::array<Jet, 2> pixel;
    project_through_lens(camera_.model.lens, lens_jets.data(), Jet(p.x(), point),
                         Jet(p.y(), point + 1), Jet(p.z(), point + 2), pixel.data());
    r = Eigen::Vector2d(pixel[0].a, pixel[1].a) - pixel_;

    Eigen::Matrix<double, 2, 3> by_point;
    by_point << pixel[0].v.tail<3>().transpose(), pixel[1].v.tail<3>().transpose();
    if (jacobians[lens_block]) {
        Eigen::Map<Eigen::Matrix<double, 2, lens_parameter_count, Eigen::RowMajor>> by(
            jacobians[lens_block]);
        by << pixel[0].v.head<lens_parameter_count>().transpose(),
            pixel[1].v.head<lens_parameter_count>().transpose();
    }
    const auto tell = [&](int block, const ChangedPose::ByChange& point_by_change) {
        Eigen::Map<Eigen::Matrix<double, 2, 6, Eigen::RowMajor>>{jacobians[block]} =
            by_point * point_by_change;
    };
    if (jacobians[camera_block]) tell(camera_block, camera.by_change(in_rig));
    by_point *= camera.by_point();
    if (jacobians[rig_block]) tell(rig_block, rig.inverse_by_change(in_world));
    by_point *= rig.by_point().transpose();
    if (jacobians[board_block]) tell(board_block, board.by_change(on_board));
    if (!face || !jacobians[face_block]) return true;
    by_point *= board.by_point();
    tell(face_block, face->by_change(corner_m_));
    return true;
}

}  // namespace vantage
