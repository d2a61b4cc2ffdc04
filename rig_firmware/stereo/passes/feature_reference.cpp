#include "rig_firmware/stereo/passes/feature_reference.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace vantage {
namespace {

int at_edge_repeated(const GreyImage& image, int x, int y) {
    return image(std::clamp(y, 0, image.rows - 1), std::clamp(x, 0, image.cols - 1));
}

bool is_census_neighbour(int dx, int dy) {
    const bool is_corner = std::abs(dx) == 4 && std::abs(dy) == 3,
               is_top_middle = dx == 0 && dy == -3;
    return (dx + dy) % 2 != 0 && !is_corner && !is_top_middle;
}

}  // namespace

cv::Mat1i feature_words(const GreyImage& luma) {
    cv::Mat1i words(luma.size());
    for (int y = 0; y < luma.rows; ++y)
        for (int x = 0; x < luma.cols; ++x) {
            std::uint32_t census = 0, bit = 1;
            for (int dy = -3; dy <= 3; ++dy)
                for (int dx = -4; dx <= 4; ++dx)
                    if (is_census_neighbour(dx, dy)) {
                        if (at_edge_repeated(luma, x + dx, y + dy) >= luma(y, x)) census |= bit;
                        bit <<= 1;
                    }
            int gradient = 0;
            for (int dy = -1; dy <= 1; ++dy)
                gradient += (dy == 0 ? 2 : 1) * (at_edge_repeated(luma, x + 1, y + dy) -
                                                 at_edge_repeated(luma, x - 1, y + dy));
            const auto level = static_cast<std::uint32_t>(std::clamp((gradient >> 2) + 16, 0, 31));
            words(y, x) = static_cast<int>(census | (level << 27));
        }
    return words;
}

int row_shift(const cv::Mat1i& left_features, const cv::Mat1i& right_features, int disparities) {
    int best_shift = 0;
    std::array<int, 5> sums{};
    for (int y = 8; y < left_features.rows; y += 16)
        for (int x = 4; x < left_features.cols; x += 8)
            for (int shift = -2; shift <= 2; ++shift) {
                const int row = std::clamp(y + shift, 0, left_features.rows - 1);
                int least = 32;
                for (int d = 0; d < std::min(disparities, x + 1); ++d) {
                    const auto unlike = static_cast<std::uint32_t>(left_features(y, x) ^
                                                                   right_features(row, x - d));
                    least = std::min(least, std::popcount(unlike & 0x07ffffffU));
                }
                sums[static_cast<std::size_t>(shift + 2)] += least;
            }
    int least = sums[2] / 16 * 15;
    for (int shift = -2; shift <= 2; ++shift)
        if (const int sum = sums[static_cast<std::size_t>(shift + 2)]; sum < least) {
            least = sum;
            best_shift = shift;
        }
    return best_shift;
}

GreyImage rows_shifted(const GreyImage& luma, int shift) {
    GreyImage shifted(luma.size());
    for (int y = 0; y < luma.rows; ++y)
        luma.row(std::clamp(y + shift, 0, luma.rows - 1)).copyTo(shifted.row(y));
    return shifted;
}

GreyImage guide_of(const GreyImage& luma) {
    GreyImage guide;
    cv::medianBlur(luma, guide, 3);
    return guide;
}

GreyImage halved(const GreyImage& luma) {
    GreyImage half((luma.rows + 1) / 2, (luma.cols + 1) / 2);
    for (int y = 0; y < half.rows; ++y)
        for (int x = 0; x < half.cols; ++x)
            half(y, x) = static_cast<unsigned char>(
                (luma(2 * y, 2 * x) + at_edge_repeated(luma, 2 * x + 1, 2 * y) +
                 at_edge_repeated(luma, 2 * x, 2 * y + 1) +
                 at_edge_repeated(luma, 2 * x + 1, 2 * y + 1) + 2) >>
                2);
    return half;
}

PermeabilityTable permeability_table(double sigma) {
    PermeabilityTable table{};
    for (std::size_t step = 0; step < table.size(); ++step)
        table[step] = static_cast<std::uint32_t>(
            std::clamp(std::lround(16 * std::exp(-static_cast<double>(step) / sigma)), 0L, 15L));
    return table;
}

cv::Mat1b permeability_of(const GreyImage& guide, const PermeabilityTable& table) {
    cv::Mat1b result(guide.size());
    const auto passes = [&](int a, int b) {
        return table[static_cast<std::size_t>(std::abs(a - b))];
    };
    for (int y = 0; y < guide.rows; ++y)
        for (int x = 0; x < guide.cols; ++x) {
            const std::uint32_t left = x > 0 ? passes(guide(y, x), guide(y, x - 1)) : 0;
            const std::uint32_t up = y > 0 ? passes(guide(y, x), guide(y - 1, x)) : 0;
            result(y, x) = static_cast<unsigned char>(left | (up << 4));
        }
    return result;
}

}  // namespace vantage
