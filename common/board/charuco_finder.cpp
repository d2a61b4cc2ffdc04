#include "common/board/charuco_finder.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <opencv2/calib3d.hpp>

#include "common/base/counted.h"
#include "common/base/error.h"
#include "common/board/board_view.h"
#include "common/board/corner_refiner.h"
#include "common/board/marker_dictionary.h"
#include "common/board/median.h"

namespace vantage {
namespace {

constexpr double max_marker_radius_px = 15;
constexpr int fewest_corners = 6;

/// Corners of a marker on the board, in metres, clockwise from the upper left.
void marker_corners_m(const BoardPattern& pattern, int id, std::vector<cv::Point2d>& out) {
    const cv::Point square = marker_square(pattern, id);
    // The origin of the board is the first INNER corner, one square from the edge.
    const double margin = 0.5 * (pattern.square_m - pattern.marker_m);
    const double x0 = (square.x - 1) * pattern.square_m + margin;
    const double y0 = (square.y - 1) * pattern.square_m + margin;
    out.insert(out.end(), {{x0, y0},
                           {x0 + pattern.marker_m, y0},
                           {x0 + pattern.marker_m, y0 + pattern.marker_m},
                           {x0, y0 + pattern.marker_m}});
}

Eigen::Vector2d apply(const cv::Matx33d& h, double x, double y) {
    const cv::Vec3d p = h * cv::Vec3d(x, y, 1);
    return {p[0] / p[2], p[1] / p[2]};
}

/// Burnt-out share of the board's whole area, as its markers place it in the image, hidden parts
/// included. Glare hides markers, so that it must not be measured between the detected ones only.
double burnt_out_share_of(const GreyImage& picture, const BoardPattern& pattern,
                          const std::map<int, FoundMarker>& markers) {
    std::vector<cv::Point2d> on_board, in_picture;
    for (const auto& [id, marker] : markers) {
        marker_corners_m(pattern, id, on_board);
        for (const cv::Point2f& p : marker.corners) in_picture.emplace_back(p.x, p.y);
    }
    const cv::Mat homography = cv::findHomography(on_board, in_picture);
    if (homography.empty()) return 0;
    const cv::Matx33d h = homography;
    const double right = pattern.columns * pattern.square_m, left = -pattern.square_m;
    const double bottom = pattern.rows * pattern.square_m, top = -pattern.square_m;
    return burnt_out_share(picture, {apply(h, left, top), apply(h, right, top),
                                     apply(h, right, bottom), apply(h, left, bottom)});
}

Eigen::Vector2d marker_middle(const BoardPattern& pattern, int id) {
    const cv::Point square = marker_square(pattern, id);
    return {square.x, square.y};
}

/// Error of a layout: how far the corners of each marker and of its three nearest neighbours are
/// from a plane with this layout, as RMS in sides of a marker. The result is the mean over all
/// markers; each counts at most one side.
double layout_misfit(const BoardPattern& pattern, const std::map<int, FoundMarker>& markers) {
    double misfits = 0;
    for (const auto& [id, marker] : markers) {
        const Eigen::Vector2d middle = marker_middle(pattern, id);
        std::vector<std::pair<double, int>> nearest;
        for (const auto& [other, unused] : markers)
            nearest.emplace_back((marker_middle(pattern, other) - middle).norm(), other);
        std::sort(nearest.begin(), nearest.end());
        std::vector<cv::Point2d> on_board, in_picture;
        for (std::size_t i = 0; i < std::min<std::size_t>(4, nearest.size()); ++i) {
            marker_corners_m(pattern, nearest[i].second, on_board);
            for (const cv::Point2f& p : markers.at(nearest[i].second).corners)
                in_picture.emplace_back(p.x, p.y);
        }
        const cv::Mat homography = cv::findHomography(on_board, in_picture);
        if (homography.empty()) {
            misfits += 1;
            continue;
        }
        double sum = 0;
        for (std::size_t i = 0; i < on_board.size(); ++i) {
            const Eigen::Vector2d there = apply(homography, on_board[i].x, on_board[i].y);
            sum += (there - Eigen::Vector2d(in_picture[i].x, in_picture[i].y)).squaredNorm();
        }
        const double side_px = cv::norm(marker.corners[1] - marker.corners[0]);
        misfits += std::min(1.0, std::sqrt(sum / static_cast<double>(on_board.size())) / side_px);
    }
    return misfits / static_cast<double>(markers.size());
}

struct Layout {
    bool is_legacy = false, is_sure = true;
};

/// Layout that the markers show, or else the described one. With an odd number of squares in each
/// row, a part of the board may look the same in both.
Layout layout_of(const BoardPattern& described, const std::map<int, FoundMarker>& markers) {
    if (!described.has_legacy_layout()) return {described.legacy};
    // The wrong layout misses by half a marker, the right one only by lens distortion and the bend
    // of the board.
    constexpr double surely_wrong = 0.1;
    BoardPattern other = described;
    other.legacy = !described.legacy;
    const double misfit = layout_misfit(described, markers), others = layout_misfit(other, markers);
    if (misfit > surely_wrong && others < 0.5 * misfit) return {other.legacy};
    return {described.legacy, others > surely_wrong && misfit < 0.5 * others};
}

}  // namespace

int marker_count(const BoardPattern& pattern) {
    return (pattern.columns + 1) * (pattern.rows + 1) / 2;
}

cv::Point marker_square(const BoardPattern& pattern, int id) {
    int count = 0;
    for (int row = 0; row <= pattern.rows; ++row)
        for (int column = 0; column <= pattern.columns; ++column)
            if ((row + column) % 2 == (pattern.starts_white() ? 0 : 1) && count++ == id)
                return {column, row};
    return {-1, -1};
}

void require_enough_markers(const BoardPattern& pattern) {
    const int there = MarkerDictionary(pattern.dictionary).marker_count();
    const int from = pattern.first_marker;
    if (there < from + marker_count(pattern))
        fail("a {} board{} needs {} markers and dictionary {} has {}; take a larger one",
             pattern.size_name(), from > 0 ? fmt::format(" that begins at marker {}", from) : "",
             marker_count(pattern), pattern.dictionary, there);
}

bool shows_mirrored_markers(const GreyImage& picture, const std::string& dictionary) {
    GreyImage flipped;
    cv::flip(picture, flipped, 1);
    return MarkerDictionary(dictionary).find(flipped).size() >= 4;
}

BoardSighting find_charuco(const GreyImage& picture, const GreyImage& exposure,
                           const BoardPattern& described, const std::vector<FoundMarker>& found) {
    BoardSighting sighting;
    BoardPattern pattern = described;
    std::map<int, FoundMarker> markers;
    for (const FoundMarker& marker : found) {
        const int id = marker.id - pattern.first_marker;
        if (id >= 0 && id < marker_count(pattern)) markers[id] = marker;
    }
    if (markers.size() < 2) {
        sighting.reason =
            fmt::format("shows {} of the {} markers of the {} board, too few to be placed",
                        markers.size(), marker_count(pattern), pattern.size_name());
        return sighting;
    }
    const Layout layout = layout_of(pattern, markers);
    pattern.legacy = layout.is_legacy;
    sighting.legacy = pattern.starts_white();
    sighting.layout_is_sure = layout.is_sure;
    std::vector<double> blurs, contrasts, spacings;
    for (int id = 0; id < pattern.corner_count(); ++id) {
        // The nearest markers predict the corner, since distortion and bend hardly count at that
        // distance.
        const Eigen::Vector3d corner = pattern.corner_m(id);
        std::vector<std::pair<double, int>> nearest;
        for (const auto& [marker_id, marker] : markers) {
            const cv::Point square = marker_square(pattern, marker_id);
            nearest.emplace_back(std::hypot((square.x - 0.5) * pattern.square_m - corner.x(),
                                            (square.y - 0.5) * pattern.square_m - corner.y()),
                                 marker_id);
        }
        std::sort(nearest.begin(), nearest.end());
        if (nearest.front().first > 1.2 * pattern.square_m) continue;
        std::vector<cv::Point2d> on_board, in_picture;
        for (std::size_t i = 0; i < std::min<std::size_t>(4, nearest.size()); ++i) {
            marker_corners_m(pattern, nearest[i].second, on_board);
            for (const cv::Point2f& p : markers[nearest[i].second].corners)
                in_picture.emplace_back(p.x, p.y);
        }
        const cv::Mat homography = cv::findHomography(on_board, in_picture);
        if (homography.empty()) continue;
        const cv::Matx33d h = homography;
        const Eigen::Vector2d start = apply(h, corner.x(), corner.y());
        const Eigen::Vector2d row = apply(h, corner.x() + pattern.square_m, corner.y()) - start;
        const Eigen::Vector2d column = apply(h, corner.x(), corner.y() + pattern.square_m) - start;
        // Markers begin inside their squares; the circle must not reach them along either edge.
        const double clear = 0.5 * (1 - pattern.marker_m / pattern.square_m);
        const double area = std::abs(row.x() * column.y() - row.y() * column.x());
        const double across = area / std::max(row.norm(), column.norm());
        const double radius =
            std::clamp(std::max(1.35 * clear, 0.25) * across, 2.5, max_marker_radius_px);
        if (start.x() < radius || start.y() < radius || start.x() > picture.cols - 1 - radius ||
            start.y() > picture.rows - 1 - radius)
            continue;
        const std::optional<CornerFit> fit = fit_corner(picture, start, row, column, radius);
        if (!fit || fit->residual > 0.4 * fit->contrast) continue;
        sighting.corners.push_back({id, corner, fit->pixel});
        blurs.push_back(fit->blur_px);
        contrasts.push_back(fit->contrast);
        spacings.push_back(0.5 * (row.norm() + column.norm()));
    }
    if (static_cast<int>(sighting.corners.size()) < fewest_corners) {
        sighting.reason = fmt::format("shows {} of the board that can be measured, fewer than {}",
                                      counted(sighting.corners.size(), "corner"), fewest_corners);
        sighting.corners.clear();
        return sighting;
    }
    sighting.burnt_out_share = burnt_out_share_of(exposure, pattern, markers);
    sighting.square_px = median(spacings);
    sighting.blur_px = median(blurs);
    sighting.contrast = median(contrasts);
    return sighting;
}

}  // namespace vantage
