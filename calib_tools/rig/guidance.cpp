#include "calib_tools/rig/guidance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/counted.h"
#include "common/base/error.h"

namespace vantage {
namespace {

constexpr double wanted_tilt_deg = 20, wanted_distance_ratio = 1.4;
constexpr std::size_t wanted_views = 10;
constexpr double degrees = 180 / std::numbers::pi;

/// Fields of the image, three by three; distortion mostly depends on corners near the border.
constexpr const char* field_names[3][3] = {{"upper left", "top", "upper right"},
                                           {"left side", "middle", "right side"},
                                           {"lower left", "bottom", "lower right"}};

}  // namespace

Coverage measure_coverage(const Bundle& bundle, int camera) {
    Coverage coverage;
    const BundleCamera& c = bundle.cameras[static_cast<std::size_t>(camera)];
    for (const BundleView& view : bundle.views) {
        if (view.camera != camera || view.corners.empty()) continue;
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        for (const BoardCorner& corner : view.corners) {
            const int column =
                static_cast<int>(corner.pixel.x() / c.model.width_px * Coverage::columns);
            const int row = static_cast<int>(corner.pixel.y() / c.model.height_px * Coverage::rows);
            ++coverage.corners_in_cell[std::clamp(row, 0, Coverage::rows - 1)]
                                      [std::clamp(column, 0, Coverage::columns - 1)];
            middle += corner.board_m / static_cast<double>(view.corners.size());
        }
        const Pose camera_from_board =
            c.camera_from_rig *
            bundle.rigs[static_cast<std::size_t>(c.rig)].world_from_rig.inverse() *
            bundle.boards[static_cast<std::size_t>(view.board)].world_from_board;
        const Eigen::Vector3d normal = camera_from_board.linear().col(2);
        const double about_y = std::atan2(normal.x(), normal.z()) * degrees;
        const double about_x = std::atan2(normal.y(), normal.z()) * degrees;
        coverage.tilt_right_deg = std::max(coverage.tilt_right_deg, about_y);
        coverage.tilt_left_deg = std::max(coverage.tilt_left_deg, -about_y);
        coverage.tilt_down_deg = std::max(coverage.tilt_down_deg, about_x);
        coverage.tilt_up_deg = std::max(coverage.tilt_up_deg, -about_x);
        const double distance = (camera_from_board * middle).z();
        coverage.nearest_m =
            coverage.nearest_m == 0 ? distance : std::min(coverage.nearest_m, distance);
        coverage.farthest_m = std::max(coverage.farthest_m, distance);
    }
    int covered = 0;
    for (const auto& row : coverage.corners_in_cell)
        covered += static_cast<int>(
            std::count_if(std::begin(row), std::end(row), [](int count) { return count > 0; }));
    coverage.covered_share = covered / static_cast<double>(Coverage::rows * Coverage::columns);
    return coverage;
}

std::vector<std::string> missing_pictures(const Bundle& bundle, int camera,
                                          const std::string& camera_name) {
    std::vector<std::string> advice;
    const Coverage coverage = measure_coverage(bundle, camera);
    std::size_t views = 0;
    for (const BundleView& view : bundle.views) views += view.camera == camera ? 1 : 0;
    if (views < wanted_views)
        advice.push_back(fmt::format("only {} of the {} camera could be used: take {} more",
                                     counted(static_cast<std::size_t>(views), "picture"),
                                     camera_name, wanted_views - views));
    std::string empty_fields;
    for (int fy = 0; fy < 3; ++fy)
        for (int fx = 0; fx < 3; ++fx) {
            int cells = 0, filled = 0;
            for (int r = fy * Coverage::rows / 3; r < (fy + 1) * Coverage::rows / 3; ++r)
                for (int c = fx * Coverage::columns / 3; c < (fx + 1) * Coverage::columns / 3;
                     ++c) {
                    ++cells;
                    filled += coverage.corners_in_cell[r][c] > 0 ? 1 : 0;
                }
            if (2 * filled < cells)
                empty_fields +=
                    (empty_fields.empty() ? "" : ", ") + std::string(field_names[fy][fx]);
        }
    if (!empty_fields.empty())
        advice.push_back(fmt::format("the {} camera saw few corners in: {}; show the board there",
                                     camera_name, empty_fields));
    const auto tilt = [&](double angle, const char* way) {
        if (angle < wanted_tilt_deg)
            advice.push_back(
                fmt::format("the board was turned {} by at most {:.0f} degrees before "
                            "the {} camera: add a picture with 30 degrees",
                            way, angle, camera_name));
    };
    tilt(std::max(coverage.tilt_left_deg, coverage.tilt_right_deg), "about the upright axis");
    tilt(std::max(coverage.tilt_up_deg, coverage.tilt_down_deg), "about the level axis");
    if (coverage.farthest_m < wanted_distance_ratio * coverage.nearest_m)
        advice.push_back(fmt::format(
            "all boards stood {:.2f} to {:.2f} m from the {} camera: add nearer and farther ones",
            coverage.nearest_m, coverage.farthest_m, camera_name));
    return advice;
}

}  // namespace vantage
