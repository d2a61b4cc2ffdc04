#include "rig_firmware/stereo/passes/feature_reference.h"

#include <algorithm>
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
