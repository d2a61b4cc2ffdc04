#include "host_app/foreground/motion/rig_motion.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace vantage {
namespace {

/// Largest width of the grid: it limits the time that optical flow takes.
constexpr int max_columns = 512;
/// Least side of an image part that optical flow works on, px.
constexpr int least_side_px = 32;
/// Largest distance between the start and the end of the flow there and back, px of the grid, plus
/// a share of the flow's length. Measured on the virtual stage with tests/bench/between_truth.
constexpr float max_round_trip_px = 1.2f, max_round_trip_share = 0.2f;
/// Largest change of a surface's disparity from pulse to pulse, 1/32 px.
constexpr int max_approach_steps = 128;
/// Moving pixels this close to each other form one region, px. At least this share of a region must
/// be reliable.
constexpr int region_px = 7;
constexpr double min_sure_share = 0.65;
/// Margin around a region, px, so that flow also covers the still pixels beside it.
constexpr int margin_px = 8;
/// Largest difference between a moved pixel and its target, grey levels, mean of 3x3.
constexpr int max_change = 40;
/// Largest difference that is sensor noise, grey levels, mean of 3x3.
constexpr int max_noise = 2;

cv::Mat1b grey_of(const ColourImage& colour, cv::Size size) {
    cv::Mat1b grey;
    cv::cvtColor(colour, grey, cv::COLOR_RGBA2GRAY);
    if (grey.size() != size) cv::resize(grey, grey, size, 0, 0, cv::INTER_AREA);
    return grey;
}

/// Returns where both images are the same: nothing moves there.
cv::Mat1b still_in(const cv::Mat1b& a, const cv::Mat1b& b) {
    cv::Mat1b difference;
    cv::absdiff(a, b, difference);
    cv::blur(difference, difference, {3, 3});
    return difference <= max_noise;
}

cv::Mat1b looks_the_same(const cv::Mat1b& here, const cv::Mat1b& there, const cv::Mat2f& way) {
    cv::Mat2f places(way.size());
    for (int y = 0; y < way.rows; ++y)
        for (int x = 0; x < way.cols; ++x)
            places(y, x) = way(y, x) + cv::Vec2f(static_cast<float>(x), static_cast<float>(y));
    cv::Mat1b moved, difference;
    cv::remap(there, moved, places, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    cv::absdiff(here, moved, difference);
    cv::blur(difference, difference, {3, 3});
    return difference <= max_change;
}

/// Returns where the flow is reliable. `disparity` belongs to the frame that it begins in and
/// `disparity_there` to the other one, both on the grid.
cv::Mat1b sure_of(const cv::Mat2f& there, const cv::Mat2f& back, const DisparityImage& disparity,
                  const DisparityImage& disparity_there) {
    cv::Mat1b sure(there.size());
    for (int y = 0; y < there.rows; ++y)
        for (int x = 0; x < there.cols; ++x) {
            const cv::Vec2f way = there(y, x);
            const int tx = cvRound(x + way[0]), ty = cvRound(y + way[1]);
            if (tx < 0 || ty < 0 || tx >= there.cols || ty >= there.rows) {
                sure(y, x) = 0;
                continue;
            }
            if (!disparity.empty() && disparity(y, x) > 0 && disparity_there(ty, tx) > 0 &&
                std::abs(disparity(y, x) - disparity_there(ty, tx)) > max_approach_steps) {
                sure(y, x) = 0;
                continue;
            }
            const cv::Vec2f round_trip = way + back(ty, tx);
            const float limit =
                max_round_trip_px + max_round_trip_share * std::hypot(way[0], way[1]);
            sure(y, x) = std::hypot(round_trip[0], round_trip[1]) <= limit ? 255 : 0;
        }
    return sure;
}

/// The moving pixels, in connected regions.
struct Regions {
    cv::Mat1i of;     ///< region of each pixel; 0: none
    cv::Mat1i stats;  ///< a row for each region, as OpenCV fills it
};

Regions regions_of(const cv::Mat1b& still) {
    cv::Mat1b moving;
    cv::dilate(cv::Mat1b(~still), moving, cv::Mat1b::ones(region_px, region_px));
    Regions regions;
    cv::Mat1d centres;
    cv::connectedComponentsWithStats(moving, regions.of, regions.stats, centres, 4, CV_32S);
    return regions;
}

/// Returns disjoint rectangles that contain all regions. Regions as small as the noise of two
/// pixels are left out.
std::vector<cv::Rect> parts_with(const Regions& regions, cv::Size size) {
    constexpr int least_px = 2 * region_px * region_px;
    const cv::Rect all({}, size);
    std::vector<cv::Rect> parts;
    for (int region = 1; region < regions.stats.rows; ++region) {
        const auto stat = [&](int which) { return regions.stats(region, which); };
        if (stat(cv::CC_STAT_AREA) < least_px) continue;
        cv::Rect part(stat(cv::CC_STAT_LEFT) - margin_px, stat(cv::CC_STAT_TOP) - margin_px,
                      stat(cv::CC_STAT_WIDTH) + 2 * margin_px,
                      stat(cv::CC_STAT_HEIGHT) + 2 * margin_px);
        part &= all;
        part.x = std::max(0, std::min(part.x, size.width - least_side_px));
        part.y = std::max(0, std::min(part.y, size.height - least_side_px));
        part |= cv::Rect(part.x, part.y, least_side_px, least_side_px);
        for (auto other = parts.begin(); other != parts.end();) {
            if ((*other & part).empty()) {
                ++other;
                continue;
            }
            part |= *other;
            parts.erase(other);
            other = parts.begin();
        }
        parts.push_back(part);
    }
    return parts;
}

/// Computes the flow in these parts of the images; elsewhere it is zero.
cv::Mat2f flow_in(const std::vector<cv::Rect>& parts, const cv::Mat1b& here,
                  const cv::Mat1b& there) {
    const auto dis = cv::DISOpticalFlow::create(cv::DISOpticalFlow::PRESET_MEDIUM);
    dis->setFinestScale(0);
    dis->setPatchStride(3);
    dis->setGradientDescentIterations(12);
    dis->setVariationalRefinementIterations(3);
    cv::Mat2f flow(here.size(), cv::Vec2f(0, 0));
    for (const cv::Rect& part : parts) {
        cv::Mat found;
        dis->calc(here(part).clone(), there(part).clone(), found);
        found.copyTo(flow(part));
    }
    return flow;
}

/// Returns the regions of which too little is reliable: a leg of which only half moves looks worse
/// than one that stays.
std::vector<int> unreliable_regions(const RigMotion& motion, const cv::Mat1b& still) {
    std::vector<double> all(static_cast<std::size_t>(motion.regions)), sure(all.size());
    for (int y = 0; y < still.rows; ++y)
        for (int x = 0; x < still.cols; ++x) {
            if (still(y, x)) continue;
            const auto region = static_cast<std::size_t>(motion.region(y, x));
            all[region] += 2;
            sure[region] += (motion.is_sure_first(y, x) != 0) + (motion.is_sure_second(y, x) != 0);
        }
    std::vector<int> unreliable;
    for (std::size_t region = 1; region < all.size(); ++region)
        if (sure[region] < min_sure_share * all[region])
            unreliable.push_back(static_cast<int>(region));
    return unreliable;
}

}  // namespace

void leave_alone(RigMotion& motion, const std::vector<int>& regions) {
    if (regions.empty()) return;
    std::vector<bool> is_left(static_cast<std::size_t>(motion.regions));
    for (const int region : regions) is_left[static_cast<std::size_t>(region)] = true;
    for (int y = 0; y < motion.region.rows; ++y)
        for (int x = 0; x < motion.region.cols; ++x) {
            if (!is_left[static_cast<std::size_t>(motion.region(y, x))]) continue;
            motion.is_sure_first(y, x) = motion.is_sure_second(y, x) = 0;
            motion.is_followed(y, x) = 0;
        }
}

RigMotion motion_between(const RigFrame& first, const RigFrame& second) {
    if (first.colour.empty() || first.colour.size() != second.colour.size() ||
        std::min(first.colour.cols, first.colour.rows) < least_side_px)
        return {};
    cv::Size size = first.colour.size();
    if (size.width > max_columns)
        size = {max_columns, std::max(least_side_px, size.height * max_columns / size.width)};
    const cv::Mat1b before = grey_of(first.colour, size), after = grey_of(second.colour, size);
    const cv::Mat1b still = still_in(before, after);
    const Regions regions = regions_of(still);
    const std::vector<cv::Rect> parts = parts_with(regions, size);
    RigMotion motion;
    motion.forward = flow_in(parts, before, after);
    motion.backward = flow_in(parts, after, before);
    motion.forward.setTo(cv::Scalar(0, 0), still);
    motion.backward.setTo(cv::Scalar(0, 0), still);
    DisparityImage near_before, near_after;
    if (!first.disparity.empty() && first.disparity.size() == second.disparity.size()) {
        cv::resize(first.disparity, near_before, size, 0, 0, cv::INTER_NEAREST);
        cv::resize(second.disparity, near_after, size, 0, 0, cv::INTER_NEAREST);
    }
    motion.is_sure_first = sure_of(motion.forward, motion.backward, near_before, near_after);
    motion.is_sure_second = sure_of(motion.backward, motion.forward, near_after, near_before);
    motion.is_sure_first &= looks_the_same(before, after, motion.forward);
    motion.is_sure_second &= looks_the_same(after, before, motion.backward);
    motion.region = regions.of;
    motion.regions = regions.stats.rows;
    motion.is_followed = cv::Mat1b(size, 255);
    leave_alone(motion, unreliable_regions(motion, still));
    return motion;
}

}  // namespace vantage
