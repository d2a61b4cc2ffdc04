#include "host_app/view_sets/image_metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <opencv2/imgproc.hpp>

#include "host_app/synthesis/synthesiser.h"

namespace vantage {
namespace {

constexpr int window_px = 11;
constexpr double window_sigma_px = 1.5;

cv::Mat1f luma(const ColourImage& image) {
    cv::Mat4f rgba;
    image.convertTo(rgba, CV_32F);
    cv::Mat1f y;
    cv::transform(rgba, y, cv::Matx14f(0.299f, 0.587f, 0.114f, 0.0f));
    return y;
}

cv::Mat1f windowed(const cv::Mat& image) {
    cv::Mat1f mean;
    cv::GaussianBlur(image, mean, {window_px, window_px}, window_sigma_px, window_sigma_px,
                     cv::BORDER_REFLECT);
    return mean;
}

constexpr int search_px = 2, block_px = 8, block_step_px = 4;
constexpr int max_offset = 3;  // of a component: 1 % of 255, rounded
const cv::Vec3i component_weights(4, 1, 1);
constexpr int sum_of_weights = 6;

using YCbCr = cv::Mat_<cv::Vec3i>;

YCbCr to_ycbcr(const ColourImage& image) {
    YCbCr result(image.size());
    for (int y = 0; y < image.rows; ++y)
        for (int x = 0; x < image.cols; ++x) {
            const auto r = static_cast<float>(image(y, x)[0]);
            const auto g = static_cast<float>(image(y, x)[1]);
            const auto b = static_cast<float>(image(y, x)[2]);
            const auto rounded = [](float value) { return static_cast<int>(std::lround(value)); };
            result(y, x) = {
                std::clamp(rounded(0.2126f * r + 0.7152f * g + 0.0722f * b), 0, 255),
                std::clamp(rounded(-0.1146f * r - 0.3854f * g + 0.5f * b) + 128, 0, 255),
                std::clamp(rounded(0.5f * r - 0.4542f * g - 0.0458f * b) + 128, 0, 255)};
        }
    return result;
}

bool counts(const cv::Mat1b& mask, int y, int x) { return mask.empty() || mask(y, x) != 0; }

/// The mean difference b - a of each component, rounded and limited.
cv::Vec3i colour_offset(const YCbCr& a, const YCbCr& b, const cv::Mat1b& mask) {
    cv::Vec3d sum;
    double pixels = 0;
    for (int y = 0; y < a.rows; ++y)
        for (int x = 0; x < a.cols; ++x) {
            if (!counts(mask, y, x)) continue;
            sum += cv::Vec3d(b(y, x) - a(y, x));
            ++pixels;
        }
    cv::Vec3i offset;
    for (int c = 0; c < 3; ++c)
        offset[c] = std::clamp(static_cast<int>(std::lround(sum[c] / std::max(pixels, 1.0))),
                               -max_offset, max_offset);
    return offset;
}

/// For each pixel of `of`, to which `offset` is added, the most similar one of `among`.
YCbCr corresponding(const YCbCr& of, const YCbCr& among, const cv::Vec3i& offset) {
    YCbCr bordered, result(of.size());
    cv::copyMakeBorder(among, bordered, search_px, search_px, search_px, search_px,
                       cv::BORDER_REPLICATE);
    for (int y = 0; y < of.rows; ++y)
        for (int x = 0; x < of.cols; ++x) {
            const cv::Vec3i wanted = of(y, x) + offset;
            int least = std::numeric_limits<int>::max();
            for (int dy = 0; dy <= 2 * search_px; ++dy)
                for (int dx = 0; dx <= 2 * search_px; ++dx) {
                    const cv::Vec3i& there = bordered(y + dy, x + dx);
                    const cv::Vec3i off = wanted - there;
                    const int error = component_weights.dot(off.mul(off));
                    if (error < least) {
                        least = error;
                        result(y, x) = there;
                    }
                }
        }
    return result;
}

double weighted(const cv::Vec3d& components) {
    return cv::Vec3d(component_weights).dot(components) / sum_of_weights;
}

double shifted_psnr_db(const YCbCr& of, const YCbCr& found, const cv::Vec3i& offset,
                       const cv::Mat1b& mask) {
    cv::Vec3d errors;
    double pixels = 0;
    for (int y = 0; y < of.rows; ++y)
        for (int x = 0; x < of.cols; ++x) {
            if (!counts(mask, y, x)) continue;
            const cv::Vec3i off = of(y, x) + offset - found(y, x);
            errors += cv::Vec3d(off.mul(off));
            ++pixels;
        }
    if (pixels == 0) return 0;
    cv::Vec3d psnr_db;
    for (int c = 0; c < 3; ++c)
        psnr_db[c] = 10 * std::log10(pixels * 255.0 * 255.0 / std::max(errors[c], 1.0));
    return weighted(psnr_db);
}

/// The structural similarity of one block of one component.
double block_ssim(const YCbCr& a, const YCbCr& b, cv::Point corner, int component) {
    constexpr double c1 = 0.01 * 255 * 0.01 * 255, c2 = 0.03 * 255 * 0.03 * 255;
    constexpr double share = 1.0 / (block_px * block_px);
    double sum_a = 0, sum_b = 0, squares_a = 0, squares_b = 0, products = 0;
    for (int y = corner.y; y < corner.y + block_px; ++y)
        for (int x = corner.x; x < corner.x + block_px; ++x) {
            const double in_a = a(y, x)[component], in_b = b(y, x)[component];
            sum_a += in_a;
            sum_b += in_b;
            squares_a += in_a * in_a;
            squares_b += in_b * in_b;
            products += in_a * in_b;
        }
    const double mean_a = share * sum_a, mean_b = share * sum_b;
    const double variances = share * (squares_a + squares_b) - mean_a * mean_a - mean_b * mean_b;
    const double covariance = share * products - mean_a * mean_b;
    return (2 * mean_a * mean_b + c1) / (mean_a * mean_a + mean_b * mean_b + c1) *
           (2 * covariance + c2) / (variances + c2);
}

double shifted_ssim(const YCbCr& of, const YCbCr& found, const cv::Vec3i& offset,
                    const cv::Mat1b& mask) {
    YCbCr compensated = found.clone();
    for (cv::Vec3i& pixel : compensated)
        for (int c = 0; c < 3; ++c) pixel[c] = std::clamp(pixel[c] - offset[c], 0, 255);
    cv::Vec3d sums;
    double blocks = 0;
    for (int y = 0; y + block_px <= of.rows; y += block_step_px)
        for (int x = 0; x + block_px <= of.cols; x += block_step_px) {
            if (!mask.empty() && 2 * cv::countNonZero(mask(cv::Rect(x, y, block_px, block_px))) <
                                     block_px * block_px)
                continue;
            for (int c = 0; c < 3; ++c) sums[c] += block_ssim(of, compensated, {x, y}, c);
            ++blocks;
        }
    return blocks > 0 ? weighted(sums / blocks) : 0;
}

}  // namespace

double psnr_db(const ColourImage& a, const ColourImage& b, const cv::Mat1b& mask) {
    CV_Assert(a.size() == b.size() && (mask.empty() || mask.size() == a.size()));
    double sum = 0, samples = 0;
    for (int y = 0; y < a.rows; ++y)
        for (int x = 0; x < a.cols; ++x) {
            if (!mask.empty() && mask(y, x) == 0) continue;
            for (int c = 0; c < 3; ++c) {
                const double difference = static_cast<double>(a(y, x)[c]) - b(y, x)[c];
                sum += difference * difference;
            }
            samples += 3;
        }
    if (samples == 0) return 0;
    if (sum == 0) return max_psnr_db;
    return std::min(max_psnr_db, 10 * std::log10(255.0 * 255.0 * samples / sum));
}

double ssim(const ColourImage& a, const ColourImage& b) {
    CV_Assert(a.size() == b.size());
    const double c1 = 0.01 * 255 * 0.01 * 255, c2 = 0.03 * 255 * 0.03 * 255;
    const cv::Mat1f x = luma(a), y = luma(b);
    const cv::Mat1f mean_x = windowed(x), mean_y = windowed(y);
    const cv::Mat1f xx = windowed(x.mul(x)), yy = windowed(y.mul(y)), xy = windowed(x.mul(y));
    const int border = std::min(a.cols, a.rows) > window_px ? window_px / 2 : 0;
    double sum = 0;
    for (int r = border; r < a.rows - border; ++r)
        for (int c = border; c < a.cols - border; ++c) {
            const double mx = mean_x(r, c), my = mean_y(r, c);
            const double vx = xx(r, c) - mx * mx, vy = yy(r, c) - my * my;
            const double vxy = xy(r, c) - mx * my;
            sum +=
                (2 * mx * my + c1) * (2 * vxy + c2) / ((mx * mx + my * my + c1) * (vx + vy + c2));
        }
    return sum / ((a.rows - 2.0 * border) * (a.cols - 2.0 * border));
}

cv::Mat1b covered_mask(const ColourImage& rendered) {
    cv::Mat1b alpha;
    cv::extractChannel(rendered, alpha, 3);
    return alpha >= 128;
}

double remembered(const ColourImage& rendered) {
    cv::Mat1b alpha;
    cv::extractChannel(rendered, alpha, 3);
    return cv::countNonZero(alpha == remembered_alpha) / static_cast<double>(rendered.total());
}

double coverage(const ColourImage& rendered) {
    return cv::countNonZero(covered_mask(rendered)) / static_cast<double>(rendered.total());
}

double mean_error(const ColourImage& a, const ColourImage& b, const cv::Mat1b& mask) {
    CV_Assert(a.size() == b.size() && mask.size() == a.size());
    cv::Mat difference;
    cv::absdiff(a, b, difference);
    const cv::Scalar mean = cv::mean(difference, mask);
    return (mean[0] + mean[1] + mean[2]) / 3;
}

cv::Mat1b depth_edge_band(const DepthImage& depth_m, int width_px) {
    constexpr double edge_ratio = 1.05;
    cv::Mat farthest, nearest;
    const cv::Mat pair = cv::getStructuringElement(cv::MORPH_RECT, {2, 2});
    cv::dilate(depth_m, farthest, pair);
    cv::erode(depth_m, nearest, pair);
    const cv::Mat1b edges = farthest > nearest * edge_ratio;
    cv::Mat1b band;
    cv::dilate(edges, band, cv::getStructuringElement(cv::MORPH_ELLIPSE, {width_px, width_px}));
    return band;
}

ColourImage difference_picture(const ColourImage& a, const ColourImage& b, double gain) {
    cv::Mat difference;
    cv::absdiff(a, b, difference);
    difference.convertTo(difference, -1, gain);
    difference |= cv::Scalar(0, 0, 0, 255);
    return difference;
}

ImmersiveMetrics immersive_metrics(const ColourImage& a, const ColourImage& b,
                                   const cv::Mat1b& mask) {
    CV_Assert(a.size() == b.size() && (mask.empty() || mask.size() == a.size()));
    const std::array images{to_ycbcr(a), to_ycbcr(b)};
    const cv::Vec3i offset = colour_offset(images[0], images[1], mask);
    ImmersiveMetrics least{std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
    for (const std::size_t from : {0, 1}) {
        const cv::Vec3i its = from == 0 ? offset : cv::Vec3i(-offset);
        const YCbCr found = corresponding(images[from], images[1 - from], its);
        least.iv_psnr_db =
            std::min(least.iv_psnr_db, shifted_psnr_db(images[from], found, its, mask));
        least.iv_ssim = std::min(least.iv_ssim, shifted_ssim(images[from], found, its, mask));
    }
    return least;
}

}  // namespace vantage
