#include "tests/bench/stereo/stereo_measures.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <opencv2/imgproc.hpp>

#include "common/image/image_file.h"

namespace vantage {
namespace {

/// Whether a plane of at least a hundredth of a pixel's disparity a pixel fits around x, y.
bool lies_on_slanted_plane(const cv::Mat1f& disparity_px, int x, int y) {
    constexpr int radius = 5;
    constexpr float least_slope = 0.01f, flatness_px = 0.02f;
    if (x < radius || y < radius || x + radius >= disparity_px.cols ||
        y + radius >= disparity_px.rows)
        return false;
    const float here = disparity_px(y, x);
    const float along = (disparity_px(y, x + radius) - disparity_px(y, x - radius)) / (2 * radius);
    const float down = (disparity_px(y + radius, x) - disparity_px(y - radius, x)) / (2 * radius);
    if (std::hypot(along, down) < least_slope) return false;
    for (int j = -radius; j <= radius; ++j)
        for (int i = -radius; i <= radius; ++i) {
            const float plane = here + along * static_cast<float>(i) + down * static_cast<float>(j);
            if (std::abs(disparity_px(y + j, x + i) - plane) > flatness_px) return false;
        }
    return true;
}

/// 255 where rows have something to be matched by: grey levels that change by 4 a pixel.
cv::Mat1b textured_along_rows(const GreyImage& luma) {
    cv::Mat1f step, energy;
    cv::Sobel(luma, step, CV_32F, 1, 0, 1, 0.5);
    cv::boxFilter(step.mul(step), energy, CV_32F, {9, 7});
    return energy >= 16;
}

}  // namespace

SubpixelError subpixel_error_on_slants(const cv::Mat1f& found_px, const FilmedPair& pair,
                                       int disparities) {
    const cv::Mat1b textured = textured_along_rows(to_grey(pair.left));
    SubpixelError result;
    double squares = 0;
    for (int y = 0; y < found_px.rows; ++y)
        for (int x = disparities; x < found_px.cols; ++x) {
            if (!textured(y, x) || !lies_on_slanted_plane(pair.disparity_px, x, y)) continue;
            ++result.judged;
            const double error = found_px(y, x) - pair.disparity_px(y, x);
            if (std::abs(error) >= 1) continue;
            ++result.inliers;
            squares += error * error;
        }
    result.rms_px = std::sqrt(squares / std::max(result.inliers, 1));
    return result;
}

cv::Mat1b plain_pixels(const GreyImage& luma) {
    cv::Mat1f along, down, gradient;
    cv::Sobel(luma, along, CV_32F, 1, 0, 1, 0.5);
    cv::Sobel(luma, down, CV_32F, 0, 1, 1, 0.5);
    cv::magnitude(along, down, gradient);
    cv::boxFilter(gradient, gradient, CV_32F, {9, 9});
    return gradient < most_plain_gradient;
}

cv::Mat1b seen_by_right(const cv::Mat1f& disparity_px) {
    cv::Mat1b seen(disparity_px.size(), 0);
    std::vector<float> nearest(static_cast<std::size_t>(disparity_px.cols));
    for (int y = 0; y < disparity_px.rows; ++y) {
        std::ranges::fill(nearest, 0.0f);
        const auto place = [&](int x) {
            return static_cast<int>(std::lround(static_cast<float>(x) - disparity_px(y, x)));
        };
        for (int x = 0; x < disparity_px.cols; ++x)
            if (place(x) >= 0) {
                float& d = nearest[static_cast<std::size_t>(place(x))];
                d = std::max(d, disparity_px(y, x));
            }
        for (int x = 0; x < disparity_px.cols; ++x)
            if (place(x) >= 0 &&
                disparity_px(y, x) + 1 >= nearest[static_cast<std::size_t>(place(x))])
                seen(y, x) = 255;
    }
    return seen;
}

std::vector<JudgedPixel> judged_pixels(const Matcher& matcher, const cv::Mat1f& found_px,
                                       const FilmedPair& pair, float most_px) {
    const cv::Mat1b confidence = matcher.confidence()->download();
    std::vector<JudgedPixel> pixels;
    for (int y = 0; y < found_px.rows; ++y)
        for (int x = 0; x < found_px.cols; ++x)
            if (std::isfinite(pair.disparity_px(y, x)))
                pixels.push_back(
                    {confidence(y, x),
                     !(std::abs(found_px(y, x) - pair.disparity_px(y, x)) <= most_px)});
    return pixels;
}

double bad_share(const std::vector<JudgedPixel>& pixels) {
    return static_cast<double>(std::ranges::count_if(pixels, &JudgedPixel::is_bad)) /
           static_cast<double>(pixels.size());
}

double sparsification_area(std::vector<JudgedPixel> pixels) {
    std::ranges::sort(pixels, std::greater(), &JudgedPixel::confidence);
    double area = 0, bad = 0;
    std::size_t taken = 0;
    while (taken < pixels.size()) {
        std::size_t end = taken;
        double bad_here = 0;
        while (end < pixels.size() && pixels[end].confidence == pixels[taken].confidence)
            bad_here += pixels[end++].is_bad;
        const double step = bad_here / static_cast<double>(end - taken);
        for (; taken < end; ++taken) {
            bad += step;
            area += bad / static_cast<double>(taken + 1);
        }
    }
    return area / static_cast<double>(pixels.size());
}

}  // namespace vantage
