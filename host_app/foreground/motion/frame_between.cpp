#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

#include "host_app/foreground/motion/rig_motion.h"

namespace vantage {
namespace {

/// The surfaces that move to each pixel of the interpolated frame: the nearest one and the one
/// behind.
class Landed {
  public:
    struct Surface {
        cv::Vec2f way{0, 0};  ///< motion between the frames, px of the colour image
        float nearness = -1;  ///< disparity steps; -1: nothing landed
    };

    explicit Landed(cv::Size size)
        : size_(size), layers_(2 * static_cast<std::size_t>(size.area())) {}

    const Surface& at(int x, int y) const { return layers_[place(x, y)]; }

    void put(int x, int y, const Surface& surface) {
        Surface& nearest = layers_[place(x, y)];
        Surface& behind = layers_[place(x, y) + 1];
        if (surface.nearness > nearest.nearness) {
            if (surface.nearness - nearest.nearness > one_surface_steps) behind = nearest;
            nearest = surface;
        } else if (nearest.nearness - surface.nearness > one_surface_steps &&
                   surface.nearness > behind.nearness) {
            behind = surface;
        }
    }

    /// Removes the nearest surface of a pixel, so that the one behind it shows.
    void uncover(int x, int y) {
        layers_[place(x, y)] = std::exchange(layers_[place(x, y) + 1], {});
    }

  private:
    std::size_t place(int x, int y) const {
        return 2 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width) +
                    static_cast<std::size_t>(x));
    }

    cv::Size size_;
    std::vector<Surface> layers_;  ///< two for each pixel
};

/// The disparity of a pixel of the colour image, 1/32 px; 0: unknown.
class NearnessOf {
  public:
    NearnessOf(DisparityImage disparity, cv::Size size)
        : disparity_(std::move(disparity)), size_(size) {}
    float operator()(int x, int y) const {
        return disparity_.empty() ? 0 : disparity_(on_grid(x, y, size_, disparity_.size()));
    }

  private:
    DisparityImage disparity_;
    cv::Size size_;
};

/// The frame that fills a pixel which no surface moved to.
enum class FillFrom { first, second, both };

/// Chooses by both disparities: the farther surface is the background, which stands still.
FillFrom fill_from(float first_steps, float second_steps, bool is_followed, float share) {
    if (!is_followed) return share >= 0.5f ? FillFrom::second : FillFrom::first;
    if (first_steps > 0 && second_steps > 0 &&
        std::abs(first_steps - second_steps) > one_surface_steps)
        return second_steps < first_steps ? FillFrom::second : FillFrom::first;
    return FillFrom::both;
}

void land(const RigFrame& frame, const cv::Mat2f& flow, const cv::Mat1b& sure, double share,
          float sign, Landed& landed) {
    const cv::Size size = frame.colour.size();
    const NearnessOf nearness(frame.disparity, size);
    const float fx = static_cast<float>(flow.cols) / static_cast<float>(size.width);
    const float fy = static_cast<float>(flow.rows) / static_cast<float>(size.height);
    const auto part = static_cast<float>(share);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const cv::Point grid = on_grid(x, y, size, flow.size());
            if (!sure(grid)) continue;
            const cv::Vec2f way{flow(grid)[0] / fx, flow(grid)[1] / fy};
            const float near = nearness(x, y);
            if (way == cv::Vec2f(0, 0)) {
                landed.put(x, y, {way, near});
                continue;
            }
            const float px = static_cast<float>(x) + part * way[0],
                        py = static_cast<float>(y) + part * way[1];
            const int left = cvFloor(px), top = cvFloor(py);
            for (int ty = top; ty <= top + 1; ++ty)
                for (int tx = left; tx <= left + 1; ++tx) {
                    if (tx < 0 || ty < 0 || tx >= size.width || ty >= size.height) continue;
                    // A pixel that is only touched at its rim is not covered.
                    if (std::abs(static_cast<float>(tx) - px) > 0.75f ||
                        std::abs(static_cast<float>(ty) - py) > 0.75f)
                        continue;
                    landed.put(tx, ty, {sign * way, near});
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

/// Returns the share of a pixel around x, y that this surface or a nearer one covers.
float covered_at(const NearnessOf& nearness, cv::Size size, float x, float y, float steps) {
    x = std::clamp(x, 0.0f, static_cast<float>(size.width - 1));
    y = std::clamp(y, 0.0f, static_cast<float>(size.height - 1));
    const int left = std::min(static_cast<int>(x), size.width - 2),
              top = std::min(static_cast<int>(y), size.height - 2);
    const float u = x - static_cast<float>(left), v = y - static_cast<float>(top);
    const auto covers = [&](int dx, int dy) {
        const float there = nearness(left + dx, top + dy);
        return there == 0 || there > steps - one_surface_steps ? 1.0f : 0.0f;
    };
    return (1 - v) * ((1 - u) * covers(0, 0) + u * covers(1, 0)) +
           v * ((1 - u) * covers(0, 1) + u * covers(1, 1));
}

/// Removes moving surfaces from pixels of which they cover less than half.
void trim_rims(Landed& landed, cv::Size size, const NearnessOf& first, const NearnessOf& second,
               float part) {
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            for (int layer = 0; layer < 2; ++layer) {
                const auto [way, nearness] = landed.at(x, y);
                if (nearness < 0 || way == cv::Vec2f(0, 0)) break;
                const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
                const float covered = (1 - part) * covered_at(first, size, fx - part * way[0],
                                                              fy - part * way[1], nearness) +
                                      part * covered_at(second, size, fx + (1 - part) * way[0],
                                                        fy + (1 - part) * way[1], nearness);
                if (covered >= 0.5f) break;
                landed.uncover(x, y);
            }
}

}  // namespace

RigFrame frame_between(const RigFrame& first, const RigFrame& second, const RigMotion& motion,
                       double share) {
    const cv::Size size = first.colour.size();
    const auto part = static_cast<float>(share);
    Landed landed(size);
    land(first, motion.forward, motion.is_sure_first, share, 1, landed);
    land(second, motion.backward, motion.is_sure_second, 1 - share, -1, landed);
    const NearnessOf near_first(first.disparity, size), near_second(second.disparity, size);
    trim_rims(landed, size, near_first, near_second, part);

    RigFrame between = first;
    between.packed = nullptr;
    between.colour = ColourImage(size);
    between.exposure =
        first.exposure +
        std::chrono::nanoseconds(static_cast<std::int64_t>(
            share * static_cast<double>((second.exposure - first.exposure).count())));
    const auto is_followed = [&](int x, int y) {
        return motion.is_followed(on_grid(x, y, size, motion.forward.size())) != 0;
    };
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const auto [way, nearness] = landed.at(x, y);
            const bool is_hole = nearness < 0;
            if (is_hole || way == cv::Vec2f(0, 0)) {
                const FillFrom filler = is_hole ? fill_from(near_first(x, y), near_second(x, y),
                                                            is_followed(x, y), part)
                                                : FillFrom::both;
                const cv::Vec4b a = first.colour(y, x), b = second.colour(y, x);
                between.colour(y, x) =
                    filler == FillFrom::first ? a
                    : filler == FillFrom::second
                        ? b
                        : cv::Vec4b((1 - part) * cv::Vec4f(a) + part * cv::Vec4f(b));
                continue;
            }
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
            const auto [way, nearness] = landed.at(pixel.x, pixel.y);
            if (nearness < 0) {
                const FillFrom filler = fill_from(a, b, is_followed(pixel.x, pixel.y), part);
                const bool is_second =
                    filler == FillFrom::both ? part >= 0.5f : filler == FillFrom::second;
                between.disparity(y, x) = is_second ? b : a;
                continue;
            }
            const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
            a = at(first.disparity, fx - part * way[0] / cx, fy - part * way[1] / cy);
            b = at(second.disparity, fx + (1 - part) * way[0] / cx, fy + (1 - part) * way[1] / cy);
            const int gap = std::abs(static_cast<int>(a) - static_cast<int>(b));
            if (a > 0 && b > 0 && gap <= one_surface_steps)
                between.disparity(y, x) = static_cast<std::uint16_t>(
                    std::lround((1 - part) * static_cast<float>(a) + part * static_cast<float>(b)));
            else
                between.disparity(y, x) = std::abs(static_cast<float>(a) - nearness) <
                                                  std::abs(static_cast<float>(b) - nearness)
                                              ? a
                                              : b;
        }
    return between;
}

}  // namespace vantage
