#include "host_app/view_sets/image_metrics.h"

#include <algorithm>
#include <cmath>

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

}  // namespace vantage
