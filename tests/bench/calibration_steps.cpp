// What calibration does from a board to a stage, on pictures whose truth is known: writes the strip
// of docs/build/calibration.md.
//   calibration_steps docs/pictures/calibration_steps.jpg
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "calib_tools/board/board_drawing.h"
#include "calib_tools/pictures/seen_picture.h"
#include "calib_tools/stage/stage_calibration.h"
#include "common/geometry/rectification_map.h"
#include "common/rectification/rectify_reference.h"
#include "tests/bench/support/picture_sheet.h"
#include "tests/bench/support/strip_program.h"
#include "tests/support/boards/rendered_stage.h"

namespace vantage {
namespace {

constexpr int width_px = 640, views = 16, columns = 4;
const cv::Size cell(320, 240);
const cv::Scalar marked(230, 60, 40, 255), drawn(40, 40, 40, 255);

ColourImage in_colour(const GreyImage& grey) {
    cv::Mat colour;
    cv::cvtColor(grey, colour, cv::COLOR_GRAY2RGBA);
    return colour;
}

/// On white, in the proportions of a cell.
ColourImage board_page(const BoardPattern& pattern) {
    constexpr int square_px = 60;
    const GreyImage board = draw_board(pattern, square_px);
    const int width = std::max(board.cols, board.rows * cell.width / cell.height) + square_px;
    GreyImage page(width * cell.height / cell.width, width, uchar{255});
    board.copyTo(page(cv::Rect((page.cols - board.cols) / 2, (page.rows - board.rows) / 2,
                               board.cols, board.rows)));
    return in_colour(page);
}

ColourImage with_corners(const GreyImage& picture, const BoardCorners& corners) {
    ColourImage colour = in_colour(picture);
    for (const BoardCorner& corner : corners)
        cv::circle(colour, cv::Point2d(corner.pixel.x(), corner.pixel.y()), 6, marked, 2,
                   cv::LINE_AA);
    return colour;
}

/// The inner halves of both pictures beside each other: lines across show that rows meet.
ColourImage rectified_halves(const GreyImage (&pair)[2], const StereoCalibration& calibration) {
    cv::Mat halves[2], both;
    for (const Side side : {Side::left, Side::right}) {
        const ColourImage rectified = rectify_reference(in_colour(pair[static_cast<int>(side)]),
                                                        make_rectification_map(calibration, side));
        const int half = rectified.cols / 2;
        halves[static_cast<int>(side)] =
            rectified(cv::Rect(half / 2, 0, half, rectified.rows)).clone();
    }
    cv::hconcat(halves, 2, both);
    constexpr int rows_apart_px = 40;
    for (int y = rows_apart_px / 2; y < both.rows; y += rows_apart_px)
        cv::line(both, {0, y}, {both.cols, y}, marked, 1);
    return both;
}

/// The rigs and what they see, the uncertainty of their places a hundred times enlarged.
ColourImage from_above(const StageCalibration& stage) {
    constexpr double px_per_m = 66, uncertain_times = 100, reach_m = 3;
    ColourImage plan(2 * cell.height, 2 * cell.width, cv::Vec4b(255, 255, 255, 255));
    const auto at = [&](const Eigen::Vector3d& world_m) {
        return cv::Point2d(0.5 * plan.cols + px_per_m * world_m.x(),
                           0.55 * plan.rows + px_per_m * world_m.z());
    };
    for (const StageCalibration::Rig& rig : stage.rigs) {
        const Pose& world_from_left = rig.calibration.world_from_left;
        const CameraModel& camera = rig.calibration.left;
        const cv::Point place = at(world_from_left.translation());
        for (const double x_px : {0.0, static_cast<double>(camera.width_px)}) {
            const Eigen::Vector3d ray((x_px - camera.cx_px) / camera.fx_px, 0, 1);
            cv::line(plan, place, at(world_from_left * (reach_m * ray)), drawn, 1, cv::LINE_AA);
        }
        const int uncertain_px =
            static_cast<int>(std::max(3.0, px_per_m * uncertain_times * rig.translation_sigma_m));
        cv::circle(plan, place, uncertain_px, marked, 2, cv::LINE_AA);
        cv::putText(plan, rig.name, place + cv::Point(14, 6), cv::FONT_HERSHEY_SIMPLEX, 0.8, drawn,
                    2, cv::LINE_AA);
    }
    return plan;
}

ColourImage steps() {
    const BoardPattern pattern = chessboard_pattern("9x6", 0.1);
    RenderedStage stage(pattern, width_px, 11);
    std::vector<StageRig> rigs;
    GreyImage shown[2];
    BoardCorners found_in_left;
    for (int r = 0; r < RenderedStage::rig_count; ++r) {
        std::vector<SeenPicture> seen[2];
        for (int i = 0; i < views; ++i) {
            const Pose world_from_board = stage.world_from_board_near(r);
            for (const int side : {0, 1}) {
                const GreyImage picture = stage.film(r, side, world_from_board, {});
                seen[side].push_back(look_at_picture(picture, fmt::format("{}.png", i), pattern));
                if (r == 0 && i == views - 1) shown[side] = picture;
            }
        }
        if (r == 0) found_in_left = seen[0].back().sighting.corners;
        const RigCalibration solved = calibrate_rig(seen[0], seen[1], pattern, {});
        rigs.push_back({.name = RenderedStage::name(r),
                        .calibration = solved.calibration,
                        .left = {},
                        .right = {},
                        .sigma = calibration_sigma(solved)});
    }
    long long instant = 0;
    const auto show = [&](const Pose& world_from_board, int first, int last) {
        for (int r = first; r <= last; ++r)
            for (const int side : {0, 1}) {
                const BoardSighting seen =
                    find_board(stage.film(r, side, world_from_board, {}), pattern);
                StageRig& rig = rigs[static_cast<std::size_t>(r)];
                if (seen.found()) (side == 0 ? rig.left : rig.right)[instant] = seen.corners;
            }
        ++instant;
    };
    show(stage.board_on_floor(), 0, RenderedStage::rig_count - 1);
    for (int pair = 0; pair + 1 < RenderedStage::rig_count; ++pair)
        for (int i = 0; i < views / 3; ++i) show(stage.board_before_pair(pair), pair, pair + 1);

    PictureSheet sheet(cell, columns);
    sheet.add("1: a board", board_page(pattern));
    sheet.add("2: its corners, found by a rig", with_corners(shown[0], found_in_left));
    sheet.add("2: rows meet in the rectified pair",
              rectified_halves(shown, rigs.front().calibration));
    sheet.add("3: the rigs in one world", from_above(calibrate_stage(rigs, pattern, 0)));
    return sheet.picture();
}

}  // namespace
}  // namespace vantage

int main(int argc, char** argv) {
    return vantage::run_strip_program("calibration_steps",
                                      "What calibration does from a board to a stage", argc, argv,
                                      vantage::steps);
}
