#include <cmath>

#include <Eigen/Dense>
#include <ceres/crs_matrix.h>

#include "calib_tools/bundle/bundle.h"
#include "calib_tools/bundle/bundle_problem.h"
#include "common/base/counted.h"
#include "common/base/error.h"

namespace vantage {
namespace {

/// Columns of the Jacobian for one parameter block, in the block's tangent space.
struct Columns {
    double* block = nullptr;
    int first = 0, count = 0;
};

}  // namespace

BundleUncertainty bundle_uncertainty(const Bundle& bundle) {
    BundleProblem problem(bundle, 0);
    ceres::Problem& ceres_problem = problem.problem();
    ceres::Problem::EvaluateOptions evaluate;
    int size = 0;
    const auto columns_of = [&](double* block) {
        Columns c;
        if (!block || ceres_problem.IsParameterBlockConstant(block)) return c;
        c = {block, size, ceres_problem.ParameterBlockTangentSize(block)};
        size += c.count;
        evaluate.parameter_blocks.push_back(block);
        return c;
    };
    std::vector<Columns> lenses, camera_poses, rig_poses, face_poses, board_poses;
    for (std::size_t i = 0; i < bundle.cameras.size(); ++i) {
        lenses.push_back(columns_of(problem.lens(i)));
        camera_poses.push_back(columns_of(problem.camera_pose(i)));
    }
    for (std::size_t i = 0; i < bundle.rigs.size(); ++i)
        rig_poses.push_back(columns_of(problem.rig_pose(i)));
    for (std::size_t i = 0; i < bundle.faces.size(); ++i)
        face_poses.push_back(columns_of(problem.face_pose(i)));
    const int shared = size;
    for (std::size_t i = 0; i < bundle.boards.size(); ++i)
        board_poses.push_back(columns_of(problem.board_pose(i)));

    std::vector<double> residuals;
    ceres::CRSMatrix jacobian;
    if (!ceres_problem.Evaluate(evaluate, nullptr, &residuals, nullptr, &jacobian))
        fail("the calibration is not finite at its solution: the pictures contradict each other");

    // Eliminates the boards' poses one by one (Schur complement), so that the matrix to invert
    // covers only the parameters of cameras and rigs.
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(shared, shared);
    std::vector<Eigen::VectorXd> scores(bundle.boards.size(), Eigen::VectorXd::Zero(shared));
    // Priors do not measure the spread of the corners.
    const std::size_t corner_rows =
        residuals.size() - static_cast<std::size_t>(problem.prior_rows());
    double squares = 0;
    for (std::size_t i = 0; i < corner_rows; ++i) squares += residuals[i] * residuals[i];
    std::vector<std::vector<int>> rows_of_board(bundle.boards.size());
    int row = 0;
    for (const BundleView& view : bundle.views)
        for (std::size_t i = 0; i < 2 * view.corners.size(); ++i)
            rows_of_board[static_cast<std::size_t>(view.board)].push_back(row++);
    for (std::size_t b = 0; b < bundle.boards.size(); ++b) {
        const Columns& own = board_poses[b];
        Eigen::MatrixXd a = Eigen::MatrixXd::Zero(shared, shared);
        Eigen::MatrixXd mixed = Eigen::MatrixXd::Zero(shared, own.count);
        Eigen::MatrixXd c = Eigen::MatrixXd::Zero(own.count, own.count);
        Eigen::VectorXd score_shared = Eigen::VectorXd::Zero(shared);
        Eigen::VectorXd score_own = Eigen::VectorXd::Zero(own.count);
        Eigen::VectorXd values_shared(shared), values_own(own.count);
        std::vector<int> touched;
        for (const int r : rows_of_board[b]) {
            touched.clear();
            values_own.setZero();
            for (int k = jacobian.rows[static_cast<std::size_t>(r)];
                 k < jacobian.rows[static_cast<std::size_t>(r) + 1]; ++k) {
                const int column = jacobian.cols[static_cast<std::size_t>(k)];
                const double value = jacobian.values[static_cast<std::size_t>(k)];
                if (column < shared) {
                    touched.push_back(column);
                    values_shared[column] = value;
                } else {
                    values_own[column - own.first] = value;
                }
            }
            const double residual = residuals[static_cast<std::size_t>(r)];
            for (const int i : touched) {
                for (const int j : touched) a(i, j) += values_shared[i] * values_shared[j];
                mixed.row(i) += values_shared[i] * values_own.transpose();
                score_shared[i] += values_shared[i] * residual;
            }
            c += values_own * values_own.transpose();
            score_own += values_own * residual;
        }
        if (own.count > 0) {
            const Eigen::LDLT<Eigen::MatrixXd> inverse(c);
            a -= mixed * inverse.solve(mixed.transpose());
            score_shared -= mixed * inverse.solve(score_own);
        }
        information += a;
        scores[b] = score_shared;
    }

    Eigen::MatrixXd prior_information = Eigen::MatrixXd::Zero(shared, shared);
    for (std::size_t r = corner_rows; r < residuals.size(); ++r)
        for (int i = jacobian.rows[r]; i < jacobian.rows[r + 1]; ++i)
            for (int j = jacobian.rows[r]; j < jacobian.rows[r + 1]; ++j)
                prior_information(jacobian.cols[static_cast<std::size_t>(i)],
                                  jacobian.cols[static_cast<std::size_t>(j)]) +=
                    jacobian.values[static_cast<std::size_t>(i)] *
                    jacobian.values[static_cast<std::size_t>(j)];
    information += prior_information;

    BundleUncertainty result;
    result.cameras.resize(bundle.cameras.size());
    result.rigs.resize(bundle.rigs.size());
    result.faces.resize(bundle.faces.size());
    const double freedom = static_cast<double>(corner_rows) - static_cast<double>(size);
    if (!(freedom > 0))
        fail("the pictures show {}, too few for the {} unknowns: take more pictures",
             counted(bundle.corner_count(), "corner"), size);
    const double variance = squares / freedom;
    result.residual_sigma_px = std::sqrt(variance);
    if (shared == 0) return result;

    // Scaled to a unit diagonal, since focal lengths and sixth powers of radii share the matrix.
    const Eigen::VectorXd diagonal = information.diagonal().cwiseMax(1e-300);
    const Eigen::VectorXd scale = diagonal.cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * information *
                                                               scale.asDiagonal());
    if (eigen.info() != Eigen::Success ||
        eigen.eigenvalues().minCoeff() < 1e-13 * eigen.eigenvalues().maxCoeff())
        fail(
            "the pictures do not determine the calibration: show the board tilted in several "
            "directions, near and far, and in every part of the picture");
    const Eigen::MatrixXd inverse = scale.asDiagonal() * eigen.eigenvectors() *
                                    eigen.eigenvalues().cwiseInverse().asDiagonal() *
                                    eigen.eigenvectors().transpose() * scale.asDiagonal();
    Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(shared, shared);
    int clusters = 0;
    for (std::size_t b = 0; b < scores.size(); ++b)
        if (!rows_of_board[b].empty()) {
            spread += scores[b] * scores[b].transpose();
            ++clusters;
        }
    // At a solution the scores of p shared unknowns sum to zero, which removes as many views' worth
    // of spread. This matters while there are few views.
    const double correction =
        static_cast<double>(clusters) / std::max(1.0, static_cast<double>(clusters) - 1.0);
    spread = correction * spread + variance * prior_information;
    const Eigen::VectorXd clustered = (inverse * spread * inverse).diagonal();
    const Eigen::VectorXd classic = variance * inverse.diagonal();
    const Eigen::VectorXd sigma = classic.cwiseMax(clustered).cwiseSqrt();

    const auto pose_sigma = [&](const Columns& c, Eigen::Vector3d& rotation,
                                Eigen::Vector3d& translation) {
        if (c.count != 6) return;
        rotation = sigma.segment<3>(c.first);
        translation = sigma.segment<3>(c.first + 3);
    };
    for (std::size_t i = 0; i < bundle.cameras.size(); ++i) {
        BundleUncertainty::Camera& out = result.cameras[i];
        out.distortion.assign(bundle.cameras[i].model.distortion.size(), 0.0);
        if (lenses[i].count > 0) {
            int k = lenses[i].first;
            out.fx_px = sigma[k++];
            out.fy_px = sigma[k++];
            out.cx_px = sigma[k++];
            out.cy_px = sigma[k++];
            for (std::size_t d = 0; d < out.distortion.size(); ++d)
                if (bundle.cameras[i].family->free[d]) out.distortion[d] = sigma[k++];
        }
        pose_sigma(camera_poses[i], out.rotation_rad, out.translation_m);
    }
    for (std::size_t i = 0; i < bundle.rigs.size(); ++i)
        pose_sigma(rig_poses[i], result.rigs[i].rotation_rad, result.rigs[i].translation_m);
    for (std::size_t i = 0; i < bundle.faces.size(); ++i)
        pose_sigma(face_poses[i], result.faces[i].rotation_rad, result.faces[i].translation_m);
    return result;
}

}  // namespace vantage
