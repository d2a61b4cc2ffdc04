#include "host_app/motion/rig_motion.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace vantage {
namespace {

constexpr int most_columns = 512;
/// How far from where it began the way there and back may end, px of the grid, and of the way's
/// length. Measured on the virtual stage: tests/bench/between_truth.
constexpr float most_doubt_px = 0.75f, most_doubt_share = 0.1f;
/// Disparities further apart than this are of two surfaces; what moves from pulse to pulse, with
/// the matcher's own errors, is not.
constexpr int one_surface_steps = 48, most_approach_steps = 128;
/// Moving pixels that are so close to each other are of one region, px; of a region so much has to
/// be sure.
constexpr int region_px = 7;
constexpr double least_sure_share = 0.6;
/// What is seen to move looks the same there, grey levels, the mean of 3x3.
constexpr int most_change = 24;
/// What sensors make of one thing, grey levels, the mean of 3x3.
constexpr int most_noise = 2;

cv::Mat1b grey_of(const ColourImage& colour, cv::Size size) {
    cv::Mat1b grey;
    cv::cvtColor(colour, grey, cv::COLOR_RGBA2GRAY);
    if (grey.size() != size) cv::resize(grey, grey, size, 0, 0, cv::INTER_AREA);
    return grey;
}

/// Where both pictures show the same: there nothing moves, whatever moves beside it.
cv::Mat1b still_in(const cv::Mat1b& a, const cv::Mat1b& b) {
    cv::Mat1b difference;
    cv::absdiff(a, b, difference);
    cv::blur(difference, difference, {3, 3});
    return difference <= most_noise;
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
    return difference <= most_change;
}

/// `disparity` of the frame that the way begins in, `disparity_there` of the other, on the grid.
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
                std::abs(disparity(y, x) - disparity_there(ty, tx)) > most_approach_steps) {
                sure(y, x) = 0;
                continue;
            }
            const cv::Vec2f doubt = way + back(ty, tx);
            const float limit = most_doubt_px + most_doubt_share * std::hypot(way[0], way[1]);
            sure(y, x) = std::hypot(doubt[0], doubt[1]) <= limit ? 255 : 0;
        }
    return sure;
}

/// What ends at a pixel of the frame between.
struct Landed {
    cv::Mat2f way;       ///< from the first to the second frame, px of the colour picture
    cv::Mat1f nearness;  ///< of what landed, disparity steps; -1: nothing did
};

/// The pixel of another grid over the same picture.
cv::Point on_grid(int x, int y, cv::Size size, cv::Size grid) {
    return {std::min((2 * x + 1) * grid.width / (2 * size.width), grid.width - 1),
            std::min((2 * y + 1) * grid.height / (2 * size.height), grid.height - 1)};
}

/// Disparity of a pixel of the colour picture, steps; 0: unknown.
class NearnessOf {
  public:
    explicit NearnessOf(const RigFrame& frame)
        : disparity_(frame.disparity), size_(frame.colour.size()) {}
    float operator()(int x, int y) const {
        return disparity_.empty() ? 0 : disparity_(on_grid(x, y, size_, disparity_.size()));
    }

  private:
    const DisparityImage& disparity_;
    cv::Size size_;
};

/// Where nothing landed: which frame tells what is there, by the disparities of both.
bool is_of_second(float first_steps, float second_steps, bool is_followed, float share) {
    if (is_followed && first_steps > 0 && second_steps > 0 &&
        std::abs(first_steps - second_steps) > one_surface_steps)
        return second_steps < first_steps;
    return share >= 0.5f;
}

void land(const RigFrame& frame, const cv::Mat2f& flow, const cv::Mat1b& sure, double share,
          float sign, Landed& landed) {
    const cv::Size size = frame.colour.size();
    const NearnessOf nearness(frame);
    const float fx = static_cast<float>(flow.cols) / static_cast<float>(size.width);
    const float fy = static_cast<float>(flow.rows) / static_cast<float>(size.height);
    const auto part = static_cast<float>(share);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const cv::Point grid = on_grid(x, y, size, flow.size());
            if (!sure(grid)) continue;
            const cv::Vec2f way{flow(grid)[0] / fx, flow(grid)[1] / fy};
            const float px = static_cast<float>(x) + part * way[0],
                        py = static_cast<float>(y) + part * way[1];
            const int left = cvFloor(px), top = cvFloor(py);
            const float near = nearness(x, y);
            for (int ty = top; ty <= top + 1; ++ty)
                for (int tx = left; tx <= left + 1; ++tx) {
                    if (tx < 0 || ty < 0 || tx >= size.width || ty >= size.height) continue;
                    // What is hit at its rim only does not stand for the pixel.
                    if (std::abs(static_cast<float>(tx) - px) > 0.75f ||
                        std::abs(static_cast<float>(ty) - py) > 0.75f)
                        continue;
                    if (near <= landed.nearness(ty, tx)) continue;
                    landed.nearness(ty, tx) = near;
                    landed.way(ty, tx) = sign * way;
                }
        }
}

cv::Vec4f sample(const ColourImage& picture, float x, float y) {
    x = std::clamp(x, 0.0f, static_cast<float>(picture.cols - 1));
    y = std::clamp(y, 0.0f, static_cast<float>(picture.rows - 1));
    const int left = std::min(static_cast<int>(x), picture.cols - 2),
              top = std::min(static_cast<int>(y), picture.rows - 2);
    const float u = x - static_cast<float>(left), v = y - static_cast<float>(top);
    const auto at = [&](int dx, int dy) { return cv::Vec4f(picture(top + dy, left + dx)); };
    return (1 - v) * ((1 - u) * at(0, 0) + u * at(1, 0)) + v * ((1 - u) * at(0, 1) + u * at(1, 1));
}

/// Takes what moves apart into regions, and leaves alone those of which too little is sure: half a
/// leg that goes on is worse than a leg that waits.
cv::Mat1b followed_in(const cv::Mat1b& still, cv::Mat1b& sure_first, cv::Mat1b& sure_second) {
    cv::Mat1b moving;
    cv::dilate(cv::Mat1b(~still), moving, cv::Mat1b::ones(region_px, region_px));
    cv::Mat1i regions;
    const int count = cv::connectedComponents(moving, regions, 4, CV_32S);
    std::vector<double> all(static_cast<std::size_t>(count)), sure(all.size());
    for (int y = 0; y < still.rows; ++y)
        for (int x = 0; x < still.cols; ++x) {
            if (still(y, x)) continue;
            const auto region = static_cast<std::size_t>(regions(y, x));
            all[region] += 2;
            sure[region] += (sure_first(y, x) != 0) + (sure_second(y, x) != 0);
        }
    cv::Mat1b followed(still.size(), 255);
    for (int y = 0; y < still.rows; ++y)
        for (int x = 0; x < still.cols; ++x) {
            const auto region = static_cast<std::size_t>(regions(y, x));
            if (region == 0 || sure[region] >= least_sure_share * all[region]) continue;
            followed(y, x) = 0;
            if (!still(y, x)) sure_first(y, x) = sure_second(y, x) = 0;
        }
    return followed;
}

}  // namespace

RigMotion motion_between(const RigFrame& first, const RigFrame& second) {
    constexpr int least_side_px = 32;
    if (first.colour.empty() || first.colour.size() != second.colour.size() ||
        std::min(first.colour.cols, first.colour.rows) < least_side_px)
        return {};
    cv::Size size = first.colour.size();
    if (size.width > most_columns)
        size = {most_columns, std::max(least_side_px, size.height * most_columns / size.width)};
    const cv::Mat1b before = grey_of(first.colour, size), after = grey_of(second.colour, size);
    const auto dis = cv::DISOpticalFlow::create(cv::DISOpticalFlow::PRESET_MEDIUM);
    RigMotion motion;
    cv::Mat forward, backward;
    dis->calc(before, after, forward);
    dis->calc(after, before, backward);
    motion.forward = forward;
    motion.backward = backward;
    const cv::Mat1b still = still_in(before, after);
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
    motion.is_followed = followed_in(still, motion.is_sure_first, motion.is_sure_second);
    return motion;
}

RigFrame frame_between(const RigFrame& first, const RigFrame& second, const RigMotion& motion,
                       double share) {
    const cv::Size size = first.colour.size();
    Landed landed{cv::Mat2f(size, cv::Vec2f(0, 0)), cv::Mat1f(size, -1.0f)};
    land(first, motion.forward, motion.is_sure_first, share, 1, landed);
    land(second, motion.backward, motion.is_sure_second, 1 - share, -1, landed);

    RigFrame between = first;
    between.packed = nullptr;
    between.colour = ColourImage(size);
    between.exposure =
        first.exposure +
        std::chrono::nanoseconds(static_cast<std::int64_t>(
            share * static_cast<double>((second.exposure - first.exposure).count())));
    const auto part = static_cast<float>(share);
    const NearnessOf near_first(first), near_second(second);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            if (landed.nearness(y, x) < 0) {
                const bool is_followed =
                    motion.is_followed(on_grid(x, y, size, motion.forward.size()));
                between.colour(y, x) =
                    is_of_second(near_first(x, y), near_second(x, y), is_followed, part)
                        ? second.colour(y, x)
                        : first.colour(y, x);
                continue;
            }
            const cv::Vec2f way = landed.way(y, x);
            const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
            const cv::Vec4f a = sample(first.colour, fx - part * way[0], fy - part * way[1]);
            const cv::Vec4f b =
                sample(second.colour, fx + (1 - part) * way[0], fy + (1 - part) * way[1]);
            between.colour(y, x) = (1 - part) * a + part * b;
        }

    if (first.disparity.empty() || first.disparity.size() != second.disparity.size())
        return between;
    const cv::Size depth = first.disparity.size();
    between.disparity = DisparityImage(depth);
    const float cx = static_cast<float>(size.width) / static_cast<float>(depth.width);
    const float cy = static_cast<float>(size.height) / static_cast<float>(depth.height);
    const auto at = [&](const DisparityImage& picture, float x, float y) {
        return picture(std::clamp(cvRound(y), 0, depth.height - 1),
                       std::clamp(cvRound(x), 0, depth.width - 1));
    };
    for (int y = 0; y < depth.height; ++y)
        for (int x = 0; x < depth.width; ++x) {
            const cv::Point pixel = on_grid(x, y, depth, size);
            std::uint16_t a = first.disparity(y, x), b = second.disparity(y, x);
            if (landed.nearness(pixel) < 0) {
                const bool is_followed =
                    motion.is_followed(on_grid(pixel.x, pixel.y, size, motion.forward.size()));
                between.disparity(y, x) = is_of_second(a, b, is_followed, part) ? b : a;
                continue;
            }
            const cv::Vec2f way = landed.way(pixel);
            const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
            a = at(first.disparity, fx - part * way[0] / cx, fy - part * way[1] / cy);
            b = at(second.disparity, fx + (1 - part) * way[0] / cx, fy + (1 - part) * way[1] / cy);
            const int gap = std::abs(static_cast<int>(a) - static_cast<int>(b));
            if (a > 0 && b > 0 && gap <= one_surface_steps)
                between.disparity(y, x) = static_cast<std::uint16_t>(
                    std::lround((1 - part) * static_cast<float>(a) + part * static_cast<float>(b)));
            else
                between.disparity(y, x) = part < 0.5f ? a : b;
        }
    return between;
}

}  // namespace vantage
