#include "calib_tools/bundle/bundle_problem.h"

#include <algorithm>

#include <ceres/autodiff_cost_function.h>
#include <ceres/manifold.h>

#include "calib_tools/bundle/corner_cost.h"

namespace vantage {
namespace {

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
    const Eigen::Matrix3d turn = rotation_of({change[0], change[1], change[2]});
    Pose result = Pose::Identity();
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
    if (huber_px > 0) loss_ = std::make_unique<ceres::HuberLoss>(huber_px);
    for (const BundleView& view : bundle.views) {
        const auto camera = static_cast<std::size_t>(view.camera);
        const auto board = static_cast<std::size_t>(view.board);
        const auto rig = static_cast<std::size_t>(bundle.cameras[camera].rig);
        for (const BoardCorner& corner : view.corners) {
            std::vector<double*> blocks{lenses_[camera].data(), camera_poses_[camera].data(),
                                        rig_poses_[rig].data(), board_poses_[board].data()};
            if (!bundle.faces.empty())
                blocks.push_back(face_poses_[static_cast<std::size_t>(corner.board)].data());
            auto cost = std::make_unique<CornerCost>(bundle, view, corner);
            problem_->AddResidualBlock(cost.release(), loss_.get(), blocks);
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
