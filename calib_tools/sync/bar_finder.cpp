#include "calib_tools/sync/bar_finder.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <opencv2/imgproc.hpp>

namespace vantage {
namespace {

constexpr std::size_t fewest_in_row = 5;
constexpr std::size_t most_rows = 6, most_spots = 120;
/// Thresholds in grey levels for changes. Spots that merge at a low threshold are separate at a
/// higher one.
constexpr int thresholds[] = {20, 40, 70, 110, 150};

/// Largest change of every pixel over the images.
GreyImage change_of(const std::vector<GreyImage>& pictures) {
    cv::Mat least = pictures.front().clone(), most = pictures.front().clone();
    for (const cv::Mat& picture : pictures) {
        cv::min(least, picture, least);
        cv::max(most, picture, most);
    }
    GreyImage change;
    cv::subtract(most, least, change);
    return change;
}

/// Round, small spots at one threshold, strongest first.
std::vector<BlinkingSpot> spots_above(const GreyImage& change, int threshold) {
    const double largest_px = change.cols / 12.0;
    cv::Mat1i labels;
    cv::Mat1i stats;
    cv::Mat1d centres;
    const int count =
        cv::connectedComponentsWithStats(change > threshold, labels, stats, centres, 8, CV_32S);
    std::vector<std::pair<double, BlinkingSpot>> found;
    for (int i = 1; i < count; ++i) {
        const int width = stats(i, cv::CC_STAT_WIDTH), height = stats(i, cv::CC_STAT_HEIGHT);
        const int area = stats(i, cv::CC_STAT_AREA);
        if (area < 2 || std::max(width, height) > largest_px) continue;
        if (std::max(width, height) > 2 * std::min(width, height) + 1) continue;
        if (area < width * height / 2) continue;
        const cv::Rect box(stats(i, cv::CC_STAT_LEFT), stats(i, cv::CC_STAT_TOP), width, height);
        const cv::Mat mask = labels(box) == i;
        const cv::Moments m = cv::moments(cv::Mat1f(cv::Mat1f(change(box)).mul(cv::Mat1f(mask))));
        if (m.m00 <= 0) continue;
        found.push_back(
            {m.m00,
             {{box.x + m.m10 / m.m00, box.y + m.m01 / m.m00}, std::sqrt(area / std::numbers::pi)}});
    }
    std::sort(found.begin(), found.end(),
              [](const auto& a, const auto& b) { return a.first > b.first; });
    if (found.size() > most_spots) found.resize(most_spots);
    std::vector<BlinkingSpot> spots;
    spots.reserve(found.size());
    for (const auto& [strength, spot] : found) spots.push_back(spot);
    return spots;
}

/// Extends a row of two neighbouring spots in one direction, while there is a spot at the next
/// expected position.
void walk_on(const std::vector<BlinkingSpot>& spots, SpotRow& row) {
    constexpr double tolerance = 0.2, most_growth = 1.15;
    while (true) {
        const BlinkingSpot &last = row.back(), &before = row[row.size() - 2];
        const cv::Point2d step = last.centre_px - before.centre_px;
        const cv::Point2d next = last.centre_px + step;
        const double step_px = cv::norm(step);
        const BlinkingSpot* nearest = nullptr;
        double way_px = tolerance * step_px;
        for (const BlinkingSpot& spot : spots) {
            const double way = cv::norm(spot.centre_px - next);
            if (way > way_px || spot.radius_px > 2.5 * last.radius_px + 1 ||
                last.radius_px > 2.5 * spot.radius_px + 1)
                continue;
            way_px = way;
            nearest = &spot;
        }
        if (!nearest || cv::norm(nearest->centre_px - last.centre_px) > most_growth * step_px)
            return;
        row.push_back(*nearest);
    }
}

/// Deviation of the spots from a straight line, as a share of their distance.
double bend_of(const SpotRow& row) {
    const cv::Point2d way = row.back().centre_px - row.front().centre_px;
    const double length = cv::norm(way), step = length / static_cast<double>(row.size() - 1);
    double worst = 0;
    for (const BlinkingSpot& spot : row)
        worst = std::max(
            worst, std::abs(way.cross(spot.centre_px - row.front().centre_px)) / length / step);
    return worst;
}

bool is_same_row(const SpotRow& a, const SpotRow& b) {
    const double reach = a.front().radius_px + b.front().radius_px;
    const auto near = [&](const BlinkingSpot& p, const BlinkingSpot& q) {
        return cv::norm(p.centre_px - q.centre_px) < reach;
    };
    return a.size() == b.size() && ((near(a.front(), b.front()) && near(a.back(), b.back())) ||
                                    (near(a.front(), b.back()) && near(a.back(), b.front())));
}

void add_rows(const std::vector<BlinkingSpot>& spots, std::vector<SpotRow>& rows) {
    constexpr double widest_spot = 0.75, most_bend = 0.25;
    for (const BlinkingSpot& first : spots)
        for (const BlinkingSpot& second : spots) {
            const double apart_px = cv::norm(second.centre_px - first.centre_px);
            if (&first == &second || apart_px < 2 ||
                first.radius_px + second.radius_px > widest_spot * 2 * apart_px)
                continue;
            SpotRow row = {second, first};
            walk_on(spots, row);
            std::reverse(row.begin(), row.end());
            walk_on(spots, row);
            if (row.size() < fewest_in_row || bend_of(row) > most_bend) continue;
            if (std::none_of(rows.begin(), rows.end(),
                             [&](const SpotRow& known) { return is_same_row(known, row); }))
                rows.push_back(std::move(row));
        }
}

}  // namespace

std::vector<SpotRow> find_spot_rows(const std::vector<GreyImage>& pictures, int& spots) {
    const GreyImage change = change_of(pictures);
    std::vector<SpotRow> rows;
    spots = 0;
    for (const int threshold : thresholds) {
        const std::vector<BlinkingSpot> found = spots_above(change, threshold);
        spots = std::max(spots, static_cast<int>(found.size()));
        add_rows(found, rows);
    }
    std::stable_sort(rows.begin(), rows.end(),
                     [](const SpotRow& a, const SpotRow& b) { return a.size() > b.size(); });
    if (rows.size() > most_rows) rows.resize(most_rows);
    return rows;
}

}  // namespace vantage
