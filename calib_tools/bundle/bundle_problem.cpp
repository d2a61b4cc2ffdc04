#include "calib_tools/bundle/bundle_problem.h"

#include <algorithm>

#include <ceres/autodiff_cost_function.h>
#include <ceres/manifold.h>
#include <ceres/rotation.h>

namespace vantage {
namespace {

/// p = exp(w) (R0 p) + t0 + dt, or its inverse.
template <class T>
void transform(const Pose& base, const T* change, const T* in, T* out) {
    const Eigen::Matrix3d& r = base.linear();
    T turned[3];
    for (int i = 0; i < 3; ++i) turned[i] = r(i, 0) * in[0] + r(i, 1) * in[1] + r(i, 2) * in[2];
    ceres::AngleAxisRotatePoint(change, turned, out);
    for (int i = 0; i < 3; ++i) out[i] += base.translation()[i] + change[3 + i];
}

template <class T>
void transform_inverse(const Pose& base, const T* change, const T* in, T* out) {
    const T back[3] = {-change[0], -change[1], -change[2]};
    T moved[3], turned[3];
    for (int i = 0; i < 3; ++i) moved[i] = in[i] - base.translation()[i] - change[3 + i];
    ceres::AngleAxisRotatePoint(back, moved, turned);
    const Eigen::Matrix3d& r = base.linear();
    for (int i = 0; i < 3; ++i)
        out[i] = r(0, i) * turned[0] + r(1, i) * turned[1] + r(2, i) * turned[2];
}

struct CornerResidual {
    const BundleCamera& camera;
    const Pose& world_from_rig;
    const Pose& world_from_board;
    Eigen::Vector3d board_m;
    Eigen::Vector2d pixel;

    template <class T>
    bool operator()(const T* lens, const T* camera_pose, const T* rig_pose, const T* board_pose,
                    T* residual) const {
        const T on_board[3] = {T(board_m.x()), T(board_m.y()), T(board_m.z())};
        return project(lens, camera_pose, rig_pose, board_pose, on_board, residual);
    }

    template <class T>
    bool project(const T* lens, const T* camera_pose, const T* rig_pose, const T* board_pose,
                 const T* on_board, T* residual) const {
        T world[3], rig[3], p[3];
        transform(world_from_board, board_pose, on_board, world);
        transform_inverse(world_from_rig, rig_pose, world, rig);
        transform(camera.camera_from_rig, camera_pose, rig, p);
        if (!(p[2] > T(1e-9))) return false;
        project_through_lens(camera.model.lens, lens, p[0], p[1], p[2], residual);
        residual[0] -= pixel.x();
        residual[1] -= pixel.y();
        return true;
    }
};

/// The same residual for one of several boards that are fixed to each other.
struct FaceCornerResidual {
    CornerResidual corner;
    const Pose& board_from_face;

    template <class T>
    bool operator()(const T* lens, const T* camera_pose, const T* rig_pose, const T* board_pose,
                    const T* face_pose, T* residual) const {
        const Eigen::Vector3d& m = corner.board_m;
        const T on_face[3] = {T(m.x()), T(m.y()), T(m.z())};
        T on_board[3];
        transform(board_from_face, face_pose, on_face, on_board);
        return corner.project(lens, camera_pose, rig_pose, board_pose, on_board, residual);
    }
};

/// Deviation of a camera's parameters from their prior, weighted so that one sigma of the prior
/// counts as one sigma of a corner.
struct PriorResidual {
    std::array<double, lens_parameter_count> lens_mean{}, lens_weight{};
    std::array<double, 6> pose_offset{},
        pose_weight{};  ///< of the current pose from that of the prior
    static constexpr int count = lens_parameter_count + 6;

    template <class T>
    bool operator()(const T* lens, const T* pose_change, T* residual) const {
        for (std::size_t i = 0; i < lens_parameter_count; ++i)
            residual[i] = lens_weight[i] * (lens[i] - lens_mean[i]);
        for (std::size_t i = 0; i < 6; ++i)
            residual[lens_parameter_count + i] = pose_weight[i] * (pose_change[i] + pose_offset[i]);
        return true;
    }
};

PriorResidual make_prior(const BundleCamera& camera, double corner_sigma_px) {
    const CameraPrior& prior = *camera.prior;
    const auto weight = [&](double sigma) { return sigma > 0 ? corner_sigma_px / sigma : 0; };
    PriorResidual r;
    const CameraModel& m = prior.model;
    const double four[] = {m.fx_px, m.fy_px, m.cx_px, m.cy_px};
    for (std::size_t i = 0; i < 4; ++i) {
        r.lens_mean[i] = four[i];
        r.lens_weight[i] = weight(prior.focal_and_centre_sigma_px[i]);
    }
    for (std::size_t i = 0; i < m.distortion.size(); ++i) {
        r.lens_mean[4 + i] = m.distortion[i];
        r.lens_weight[4 + i] = weight(prior.distortion_sigma[i]);
    }
    // The poses differ by little, so that their rotation vectors can be added.
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(camera.camera_from_rig.linear() *
                                                 prior.camera_from_rig.linear().transpose()));
    const Eigen::Vector3d rotation = turn.angle() * turn.axis();
    const Eigen::Vector3d translation =
        camera.camera_from_rig.translation() - prior.camera_from_rig.translation();
    for (int i = 0; i < 3; ++i) {
        const auto k = static_cast<std::size_t>(i);
        r.pose_offset[k] = rotation[i];
        r.pose_offset[3 + k] = translation[i];
        r.pose_weight[k] = weight(prior.rotation_sigma_rad[i]);
        r.pose_weight[3 + k] = weight(prior.translation_sigma_m[i]);
    }
    return r;
}

}  // namespace

Pose changed(const Pose& pose, const BundleProblem::Change& change) {
    const Eigen::Vector3d w(change[0], change[1], change[2]);
    Pose result = Pose::Identity();
    const double angle = w.norm();
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    if (angle > 0) turn = Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
    // Converting through a quaternion keeps the matrix a rotation after many small changes.
    result.linear() = Eigen::Quaterniond(turn * pose.linear()).normalized().toRotationMatrix();
    result.translation() = pose.translation() + Eigen::Vector3d(change[3], change[4], change[5]);
    return result;
}

BundleProblem::BundleProblem(const Bundle& bundle, double huber_px)
    : lenses_(bundle.cameras.size()),
      camera_poses_(bundle.cameras.size(), Change{}),
      rig_poses_(bundle.rigs.size(), Change{}),
      face_poses_(bundle.faces.size(), Change{}),
      board_poses_(bundle.boards.size(), Change{}) {
    ceres::Problem::Options options;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    problem_ = std::make_unique<ceres::Problem>(options);
    for (std::size_t i = 0; i < bundle.cameras.size(); ++i) {
        const CameraModel& m = bundle.cameras[i].model;
        lenses_[i] = {m.fx_px, m.fy_px, m.cx_px, m.cy_px};
        std::copy(m.distortion.begin(), m.distortion.end(), lenses_[i].begin() + 4);
    }
    using Cost = ceres::AutoDiffCostFunction<CornerResidual, 2, lens_parameter_count, 6, 6, 6>;
    using FaceCost =
        ceres::AutoDiffCostFunction<FaceCornerResidual, 2, lens_parameter_count, 6, 6, 6, 6>;
    if (huber_px > 0) loss_ = std::make_unique<ceres::HuberLoss>(huber_px);
    for (const BundleView& view : bundle.views) {
        const auto camera = static_cast<std::size_t>(view.camera);
        const auto board = static_cast<std::size_t>(view.board);
        const auto rig = static_cast<std::size_t>(bundle.cameras[camera].rig);
        for (const BoardCorner& corner : view.corners) {
            const CornerResidual of_corner{bundle.cameras[camera], bundle.rigs[rig].world_from_rig,
                                           bundle.boards[board].world_from_board, corner.board_m,
                                           corner.pixel};
            if (bundle.faces.empty()) {
                auto residual = std::make_unique<CornerResidual>(of_corner);
                problem_->AddResidualBlock(new Cost(residual.release()), loss_.get(),
                                           lenses_[camera].data(), camera_poses_[camera].data(),
                                           rig_poses_[rig].data(), board_poses_[board].data());
            } else {
                const auto face = static_cast<std::size_t>(corner.board);
                auto residual = std::make_unique<FaceCornerResidual>(
                    FaceCornerResidual{of_corner, bundle.faces[face].board_from_face});
                problem_->AddResidualBlock(new FaceCost(residual.release()), loss_.get(),
                                           lenses_[camera].data(), camera_poses_[camera].data(),
                                           rig_poses_[rig].data(), board_poses_[board].data(),
                                           face_poses_[face].data());
            }
        }
    }
    for (std::size_t i = 0; i < bundle.cameras.size(); ++i) {
        if (!bundle.cameras[i].prior || !lens(i)) continue;
        using PriorCost = ceres::AutoDiffCostFunction<PriorResidual, PriorResidual::count,
                                                      lens_parameter_count, 6>;
        auto residual =
            std::make_unique<PriorResidual>(make_prior(bundle.cameras[i], bundle.corner_sigma_px));
        problem_->AddResidualBlock(new PriorCost(residual.release()), nullptr, lenses_[i].data(),
                                   camera_poses_[i].data());
        ++prior_count_;
    }
    for (std::size_t i = 0; i < bundle.cameras.size(); ++i) {
        const BundleCamera& c = bundle.cameras[i];
        if (double* block = lens(i)) {
            std::vector<int> constant;
            for (int k = 0; k < 8; ++k)
                if (!c.family->free[static_cast<std::size_t>(k)]) constant.push_back(4 + k);
            if (!c.solve_lens)
                problem_->SetParameterBlockConstant(block);
            else if (!constant.empty())
                problem_->SetManifold(block,
                                      new ceres::SubsetManifold(lens_parameter_count, constant));
        }
        if (double* block = camera_pose(i); block && !c.solve_pose)
            problem_->SetParameterBlockConstant(block);
    }
    for (std::size_t i = 0; i < bundle.rigs.size(); ++i)
        if (double* block = rig_pose(i); block && !bundle.rigs[i].solve)
            problem_->SetParameterBlockConstant(block);
    for (std::size_t i = 0; i < bundle.faces.size(); ++i)
        if (double* block = face_pose(i); block && !bundle.faces[i].solve)
            problem_->SetParameterBlockConstant(block);
    for (std::size_t i = 0; i < bundle.boards.size(); ++i)
        if (double* block = board_pose(i); block && !bundle.boards[i].solve)
            problem_->SetParameterBlockConstant(block);
}

void BundleProblem::apply_to(Bundle& bundle) const {
    for (std::size_t i = 0; i < bundle.cameras.size(); ++i) {
        BundleCamera& c = bundle.cameras[i];
        const auto& p = lenses_[i];
        c.model.fx_px = p[0];
        c.model.fy_px = p[1];
        c.model.cx_px = p[2];
        c.model.cy_px = p[3];
        std::copy_n(p.begin() + 4, c.model.distortion.size(), c.model.distortion.begin());
        c.camera_from_rig = changed(c.camera_from_rig, camera_poses_[i]);
    }
    for (std::size_t i = 0; i < bundle.rigs.size(); ++i)
        bundle.rigs[i].world_from_rig = changed(bundle.rigs[i].world_from_rig, rig_poses_[i]);
    for (std::size_t i = 0; i < bundle.faces.size(); ++i)
        bundle.faces[i].board_from_face = changed(bundle.faces[i].board_from_face, face_poses_[i]);
    for (std::size_t i = 0; i < bundle.boards.size(); ++i)
        bundle.boards[i].world_from_board =
            changed(bundle.boards[i].world_from_board, board_poses_[i]);
}

}  // namespace vantage
