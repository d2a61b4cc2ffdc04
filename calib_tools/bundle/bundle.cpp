#include "calib_tools/bundle/bundle.h"

#include <array>
#include <cmath>

#include <ceres/ordered_groups.h>
#include <ceres/solver.h>
#include <glog/logging.h>

#include "calib_tools/bundle/bundle_problem.h"

namespace vantage {

Eigen::Vector2d Bundle::residual_px(const BundleView& view, const BoardCorner& corner) const {
    const BundleCamera& camera = cameras[static_cast<std::size_t>(view.camera)];
    Eigen::Vector3d on_board = corner.board_m;
    if (!faces.empty())
        on_board = faces[static_cast<std::size_t>(corner.board)].board_from_face * on_board;
    const Eigen::Vector3d p =
        camera.camera_from_rig *
        (rigs[static_cast<std::size_t>(camera.rig)].world_from_rig.inverse() *
         (boards[static_cast<std::size_t>(view.board)].world_from_board * on_board));
    if (!(p.z() > 0)) return Eigen::Vector2d::Constant(1e6);
    std::array<double, lens_parameter_count> lens{camera.model.fx_px, camera.model.fy_px,
                                                  camera.model.cx_px, camera.model.cy_px};
    std::copy(camera.model.distortion.begin(), camera.model.distortion.end(), lens.begin() + 4);
    Eigen::Vector2d pixel;
    project_through_lens(camera.model.lens, lens.data(), p.x(), p.y(), p.z(), pixel.data());
    return pixel - corner.pixel;
}

double Bundle::view_rms_px(const BundleView& view) const {
    double sum = 0;
    for (const BoardCorner& corner : view.corners) sum += residual_px(view, corner).squaredNorm();
    return view.corners.empty() ? 0 : std::sqrt(sum / static_cast<double>(view.corners.size()));
}

double Bundle::rms_px() const {
    double sum = 0;
    for (const BundleView& view : views)
        for (const BoardCorner& corner : view.corners)
            sum += residual_px(view, corner).squaredNorm();
    const std::size_t count = corner_count();
    return count == 0 ? 0 : std::sqrt(sum / static_cast<double>(count));
}

std::size_t Bundle::corner_count() const {
    std::size_t count = 0;
    for (const BundleView& view : views) count += view.corners.size();
    return count;
}

bool solve_bundle(Bundle& bundle, const BundleOptions& options) {
    BundleProblem problem(bundle, options.huber_px);
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_SCHUR;
    solver.max_num_iterations = options.max_iterations;
    solver.num_threads = 1;
    solver.function_tolerance = 1e-10;
    solver.parameter_tolerance = 1e-10;
    solver.logging_type = ceres::SILENT;
    // Boards are connected only through cameras and rigs, so that they are eliminated first. Ceres
    // orders the blocks of a group by address, so that each group has blocks of one array only.
    enum Group { of_boards, of_faces, of_rigs, of_lenses, of_cameras };
    auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    const auto add = [&](double* block, int group) {
        if (block) ordering->AddElementToGroup(block, group);
    };
    for (std::size_t i = 0; i < bundle.boards.size(); ++i) add(problem.board_pose(i), of_boards);
    for (std::size_t i = 0; i < bundle.faces.size(); ++i) add(problem.face_pose(i), of_faces);
    for (std::size_t i = 0; i < bundle.rigs.size(); ++i) add(problem.rig_pose(i), of_rigs);
    for (std::size_t i = 0; i < bundle.cameras.size(); ++i) {
        add(problem.lens(i), of_lenses);
        add(problem.camera_pose(i), of_cameras);
    }
    solver.linear_solver_ordering = ordering;
    // Failed steps are a normal part of the search; the residuals judge the result.
    FLAGS_minloglevel = google::GLOG_FATAL;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem.problem(), &summary);
    if (!summary.IsSolutionUsable() || !std::isfinite(summary.final_cost)) return false;
    problem.apply_to(bundle);
    return true;
}

}  // namespace vantage
