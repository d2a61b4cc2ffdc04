#include "common/board/chessboard_finder.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "common/base/error.h"
#include "common/board/board_view.h"
#include "common/board/corner_grid.h"
#include "common/board/corner_refiner.h"
#include "common/board/median.h"

namespace vantage {
namespace {

// Share of the distance to the next edge: the circle of the fit must not reach that edge's blur.
constexpr double clear_share = 0.7;
constexpr double max_radius_px = 15;
constexpr double fewest_measured = 0.7;  // share of the corners

std::optional<CornerGrid> to_grid(const std::vector<cv::Point2f>& corners, cv::Size size,
                                  double scale) {
    if (static_cast<int>(corners.size()) != size.area()) return std::nullopt;
    CornerGrid grid{size.width, size.height, {}};
    // Pixel centres are at integers, so that an enlarged image is shifted by half a pixel.
    for (const cv::Point2f& p : corners)
        grid.pixels.emplace_back((p.x + 0.5) / scale - 0.5, (p.y + 0.5) / scale - 0.5);
    return without_strays(grid);
}

/// No equalisation and no adaptive threshold. On an evenly lit, noisy wall either of them creates
/// thousands of specks, and OpenCV takes many seconds to find no board among them.
constexpr int quick_search = 0;

std::optional<CornerGrid> find_grid(const GreyImage& picture, cv::Size size) {
    std::vector<cv::Point2f> corners;
    if (cv::findChessboardCorners(picture, size, corners, quick_search))
        return to_grid(corners, size, 1);
    // Small squares need an enlarged image. Large images are searched at reduced size, since
    // corners are measured at full size afterwards.
    constexpr double small_px = 800, large_px = 1600;
    const double scale = picture.cols <= small_px ? 2 : std::min(1.0, large_px / picture.cols);
    cv::Mat scaled = picture;
    if (scale != 1)
        cv::resize(picture, scaled, {}, scale, scale, scale > 1 ? cv::INTER_CUBIC : cv::INTER_AREA);
    if (cv::findChessboardCornersSB(scaled, size, corners, cv::CALIB_CB_NORMALIZE_IMAGE))
        return to_grid(corners, size, scale);
    return std::nullopt;
}

struct RefinedGrid {
    CornerGrid grid;
    std::vector<bool> measured;  ///< false: hidden or burnt out, and its position is an estimate
    double blur_px = 0, contrast = 0;
};

Eigen::Vector2d neighbour_direction(const CornerGrid& g, int c, int r, int dc, int dr) {
    const int c0 = std::max(0, c - dc), c1 = std::min(g.columns - 1, c + dc);
    const int r0 = std::max(0, r - dr), r1 = std::min(g.rows - 1, r + dr);
    return g.at(c1, r1) - g.at(c0, r0);
}

/// True if the squares continue beyond one of the sides, so that the board is larger.
bool continues_beyond(const GreyImage& picture, const RefinedGrid& refined) {
    const CornerGrid& grid = refined.grid;
    const CornerGrid sides[] = {grid, grid.half_turned(), grid.transposed(),
                                grid.transposed().half_turned()};
    for (const CornerGrid& g : sides) {
        int inside = 0, crossings = 0;
        for (int c = 0; c < g.columns; ++c) {
            // Extrapolates three corners of a line, which is exact enough in perspective for one
            // square.
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
            // The blurred outer corner of a black square looks like half a crossing.
            if (fit && fit->contrast > 0.65 * refined.contrast &&
                fit->residual < 0.35 * fit->contrast && fit->blur_px < 3 * refined.blur_px &&
                (fit->pixel - next).norm() < 0.2 * step.norm())
                ++crossings;
        }
        if (inside >= 3 && crossings > 0.6 * inside) return true;
    }
    return false;
}

std::optional<RefinedGrid> refine(const GreyImage& picture, const CornerGrid& rough) {
    RefinedGrid refined{rough, {}, 0, 0};
    std::vector<std::optional<CornerFit>> fits(rough.pixels.size());
    // The second pass starts from accurate corners, so that its circles and directions follow the
    // true edges.
    for (int pass = 0; pass < 2; ++pass) {
        const CornerGrid start = refined.grid;
        std::vector<double> contrasts, blurs;
        for (int r = 0; r < start.rows; ++r)
            for (int c = 0; c < start.columns; ++c) {
                const double radius =
                    std::clamp(clear_radius_px(start, c, r, clear_share), 2.5, max_radius_px);
                std::optional<CornerFit>& fit =
                    fits[static_cast<std::size_t>(r * start.columns + c)];
                fit = fit_corner(picture, start.at(c, r), neighbour_direction(start, c, r, 1, 0),
                                 neighbour_direction(start, c, r, 0, 1), radius);
                if (!fit) continue;
                contrasts.push_back(fit->contrast);
                blurs.push_back(fit->blur_px);
            }
        refined.blur_px = median(blurs);
        refined.contrast = median(contrasts);
        // A finger or a highlight can be fitted too, but with less contrast and a larger residual
        // than the other corners.
        refined.measured.assign(fits.size(), false);
        for (std::size_t i = 0; i < fits.size(); ++i) {
            if (!fits[i] || fits[i]->contrast < 0.3 * refined.contrast ||
                fits[i]->residual > 0.4 * fits[i]->contrast)
                continue;
            refined.measured[i] = true;
            refined.grid.pixels[i] = fits[i]->pixel;
        }
    }
    const auto count = std::count(refined.measured.begin(), refined.measured.end(), true);
    if (static_cast<double>(count) < fewest_measured * static_cast<double>(fits.size()))
        return std::nullopt;
    return refined;
}

/// Burnt-out share of the area between the outer corners of the grid.
double burnt_out_share_of(const GreyImage& picture, const CornerGrid& grid) {
    const int right = grid.columns - 1, bottom = grid.rows - 1;
    return burnt_out_share(
        picture, {grid.at(0, 0), grid.at(right, 0), grid.at(right, bottom), grid.at(0, bottom)});
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
        const double burnt_out = burnt_out_share_of(picture, *rough);
        sighting.reason =
            "has corners of the board that are too small, blurred or hidden to be "
            "measured";
        if (burnt_out > 0.1)
            sighting.reason +=
                fmt::format(": {:.0f} % of the board is overexposed (glare)", 100 * burnt_out);
        return sighting;
    }
    if (continues_beyond(picture, *refined)) {
        sighting.reason =
            fmt::format("shows a board with more than {} inner corners", pattern.size_name());
        return sighting;
    }
    for (int id = 0; id < pattern.corner_count(); ++id)
        if (refined->measured[static_cast<std::size_t>(id)])
            sighting.corners.push_back(
                {id, pattern.corner_m(id), refined->grid.pixels[static_cast<std::size_t>(id)]});
    sighting.burnt_out_share = burnt_out_share_of(picture, refined->grid);
    sighting.square_px = refined->grid.median_spacing_px();
    sighting.blur_px = refined->blur_px;
    sighting.contrast = refined->contrast;
    return sighting;
}

std::optional<BoardPattern> find_other_size(const GreyImage& picture, const BoardPattern& pattern) {
    // The search needs only the number of squares, so that a reduced image is enough.
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
    // Common mistakes (counting squares instead of corners, one side miscounted), then common
    // boards.
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
        if (!cv::findChessboardCorners(small, size, corners, quick_search)) continue;
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
