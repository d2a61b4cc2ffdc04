#include "calib_tools/board/chessboard_finder.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "calib_tools/board/corner_grid.h"
#include "calib_tools/board/corner_refiner.h"
#include "calib_tools/board/median.h"
#include "common/base/error.h"

namespace vantage {
namespace {

// Of the distance to the next edge: the fit's circle must not reach the next edge's blur.
constexpr double clear_share = 0.7;
constexpr double max_radius_px = 15;

std::optional<CornerGrid> to_grid(const std::vector<cv::Point2f>& corners, cv::Size size,
                                  double scale) {
    if (static_cast<int>(corners.size()) != size.area()) return std::nullopt;
    CornerGrid grid{size.width, size.height, {}};
    // Pixel centres are at integers, so an enlarged picture is shifted by half a pixel.
    for (const cv::Point2f& p : corners)
        grid.pixels.emplace_back((p.x + 0.5) / scale - 0.5, (p.y + 0.5) / scale - 0.5);
    return grid;
}

std::optional<CornerGrid> find_grid(const GreyImage& picture, cv::Size size) {
    std::vector<cv::Point2f> corners;
    const int flags = cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE;
    if (cv::findChessboardCorners(picture, size, corners, flags | cv::CALIB_CB_FAST_CHECK))
        return to_grid(corners, size, 1);
    // Small squares need an enlarged picture; large pictures are searched smaller first.
    const double scale = picture.cols <= 800 ? 2 : 1;
    cv::Mat enlarged = picture;
    if (scale != 1) cv::resize(picture, enlarged, {}, scale, scale, cv::INTER_CUBIC);
    if (scale != 1 && cv::findChessboardCorners(enlarged, size, corners, flags))
        return to_grid(corners, size, scale);
    corners.clear();
    if (cv::findChessboardCornersSB(enlarged, size, corners, cv::CALIB_CB_NORMALIZE_IMAGE))
        return to_grid(corners, size, scale);
    return std::nullopt;
}

struct RefinedGrid {
    CornerGrid grid;
    double blur_px = 0, contrast = 0;
};

Eigen::Vector2d neighbour_direction(const CornerGrid& g, int c, int r, int dc, int dr) {
    const int c0 = std::max(0, c - dc), c1 = std::min(g.columns - 1, c + dc);
    const int r0 = std::max(0, r - dr), r1 = std::min(g.rows - 1, r + dr);
    return g.at(c1, r1) - g.at(c0, r0);
}

/// True if the pattern of squares goes on beyond one of the sides: then the board is larger.
bool continues_beyond(const GreyImage& picture, const RefinedGrid& refined) {
    const CornerGrid& grid = refined.grid;
    const CornerGrid sides[] = {grid, grid.half_turned(), grid.transposed(),
                                grid.transposed().half_turned()};
    for (const CornerGrid& g : sides) {
        int inside = 0, crossings = 0;
        for (int c = 0; c < g.columns; ++c) {
            // Three corners of a line extrapolated: exact enough in perspective for one square.
            const Eigen::Vector2d step = g.at(c, 0) - g.at(c, 1);
            const Eigen::Vector2d next = 3 * g.at(c, 0) - 3 * g.at(c, 1) + g.at(c, 2);
            const double radius =
                std::clamp(0.7 * clear_radius_px(g, c, 0, clear_share), 2.5, max_radius_px);
            if (next.x() < radius || next.y() < radius || next.x() > picture.cols - 1 - radius ||
                next.y() > picture.rows - 1 - radius)
                continue;
            ++inside;
            const std::optional<CornerFit> fit =
                fit_corner(picture, next, neighbour_direction(g, c, 0, 1, 0), step, radius);
            if (fit && fit->contrast > 0.4 * refined.contrast &&
                fit->residual < 0.35 * fit->contrast && fit->blur_px < 3 * refined.blur_px &&
                (fit->pixel - next).norm() < 0.2 * step.norm())
                ++crossings;
        }
        if (inside >= 3 && crossings > 0.6 * inside) return true;
    }
    return false;
}

std::optional<RefinedGrid> refine(const GreyImage& picture, const CornerGrid& rough) {
    std::vector<cv::Point2f> points;
    for (const Eigen::Vector2d& p : rough.pixels)
        points.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
    RefinedGrid refined{rough, 0, 0};
    std::vector<double> blurs, contrasts;
    // Twice: the second time from corners that are already good, so that circles and directions
    // come from true edges.
    for (int pass = 0; pass < 2; ++pass) {
        const CornerGrid start = refined.grid;
        blurs.clear();
        contrasts.clear();
        for (int r = 0; r < start.rows; ++r)
            for (int c = 0; c < start.columns; ++c) {
                const double radius =
                    std::clamp(clear_radius_px(start, c, r, clear_share), 2.5, max_radius_px);
                const std::optional<CornerFit> fit =
                    fit_corner(picture, start.at(c, r), neighbour_direction(start, c, r, 1, 0),
                               neighbour_direction(start, c, r, 0, 1), radius);
                if (!fit) continue;
                refined.grid.pixels[static_cast<std::size_t>(r * start.columns + c)] = fit->pixel;
                blurs.push_back(fit->blur_px);
                contrasts.push_back(fit->contrast);
            }
        if (blurs.size() < start.pixels.size()) return std::nullopt;
    }
    refined.blur_px = median(blurs);
    refined.contrast = median(contrasts);
    return refined;
}

}  // namespace

bool looks_alike_half_turned(const BoardPattern& pattern) {
    return (pattern.columns + pattern.rows) % 2 == 0;
}

BoardCorners half_turned(const BoardCorners& corners, const BoardPattern& pattern) {
    BoardCorners turned;
    for (auto corner = corners.rbegin(); corner != corners.rend(); ++corner) {
        const int id = pattern.corner_count() - 1 - corner->id;
        turned.push_back({id, pattern.corner_m(id), corner->pixel});
    }
    return turned;
}

BoardSighting find_chessboard(const GreyImage& picture, const BoardPattern& pattern) {
    BoardSighting sighting;
    const std::optional<CornerGrid> rough =
        find_grid(picture, cv::Size(pattern.columns, pattern.rows));
    if (!rough) {
        sighting.reason = fmt::format("shows no whole {} board", pattern.size_name());
        return sighting;
    }
    const std::optional<RefinedGrid> refined = refine(picture, canonical(picture, *rough));
    if (!refined) {
        sighting.reason = "has corners of the board that are too blurred or hidden to be measured";
        return sighting;
    }
    if (continues_beyond(picture, *refined)) {
        sighting.reason =
            fmt::format("shows a board with more than {} inner corners", pattern.size_name());
        return sighting;
    }
    for (int id = 0; id < pattern.corner_count(); ++id)
        sighting.corners.push_back(
            {id, pattern.corner_m(id), refined->grid.pixels[static_cast<std::size_t>(id)]});
    sighting.square_px = refined->grid.median_spacing_px();
    sighting.blur_px = refined->blur_px;
    sighting.contrast = refined->contrast;
    return sighting;
}

std::optional<BoardPattern> find_other_size(const GreyImage& picture, const BoardPattern& pattern) {
    // Large pictures are searched smaller: the count of squares is wanted, not their places.
    const double scale = std::min(1.0, 800.0 / picture.cols);
    GreyImage small = picture;
    if (scale < 1) cv::resize(picture, small, {}, scale, scale, cv::INTER_AREA);
    std::vector<cv::Size> sizes;
    const auto add = [&](int columns, int rows) {
        const cv::Size size(std::max(columns, rows), std::min(columns, rows));
        const bool same = size.width == std::max(pattern.columns, pattern.rows) &&
                          size.height == std::min(pattern.columns, pattern.rows);
        if (size.height >= 3 && !same && std::find(sizes.begin(), sizes.end(), size) == sizes.end())
            sizes.push_back(size);
    };
    // Squares counted instead of corners, one of the sides miscounted, and the boards in common
    // use.
    add(pattern.columns - 1, pattern.rows - 1);
    for (const int d : {1, -1, 2, -2}) {
        add(pattern.columns + d, pattern.rows);
        add(pattern.columns, pattern.rows + d);
        add(pattern.columns + d, pattern.rows + d);
        add(pattern.columns + d, pattern.rows - d);
    }
    constexpr int common[][2] = {{9, 6},  {8, 6},  {7, 6},  {8, 5}, {7, 5}, {6, 5},
                                 {6, 4},  {5, 4},  {7, 7},  {8, 8}, {9, 7}, {10, 7},
                                 {11, 8}, {11, 7}, {12, 8}, {12, 9}};
    for (const auto& [columns, rows] : common) add(columns, rows);
    for (const cv::Size& size : sizes) {
        std::vector<cv::Point2f> corners;
        if (!cv::findChessboardCorners(small, size, corners,
                                       cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE |
                                           cv::CALIB_CB_FAST_CHECK))
            continue;
        const std::optional<RefinedGrid> refined =
            refine(small, canonical(small, *to_grid(corners, size, 1)));
        if (!refined || continues_beyond(small, *refined)) continue;
        BoardPattern other = pattern;
        other.columns = size.width;
        other.rows = size.height;
        return other;
    }
    return std::nullopt;
}

}  // namespace vantage
