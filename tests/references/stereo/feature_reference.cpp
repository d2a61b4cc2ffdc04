#include "tests/references/stereo/feature_reference.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "common/image/image_file.h"
#include "tests/references/stereo/perm_reference.h"

namespace vantage {
namespace {

int at_edge_repeated(const GreyImage& image, int x, int y) {
    return image(std::clamp(y, 0, image.rows - 1), std::clamp(x, 0, image.cols - 1));
}

bool is_census_neighbour(int dx, int dy) { return (dx + dy) % 2 != 0 && !(dx == 3 && dy == -2); }

/// Differences of the sums of three lines of pixels weighted 1, 2, 1; (dx, dy) leads along them.
int sobel(const GreyImage& luma, int x, int y, int dx, int dy) {
    int sum = 0;
    for (int i = -1; i <= 1; ++i)
        sum += (i == 0 ? 2 : 1) * (at_edge_repeated(luma, x + dx + i * dy, y + dy + i * dx) -
                                   at_edge_repeated(luma, x - dx + i * dy, y - dy + i * dx));
    return sum;
}

GreyImage shifted_plane(const GreyImage& plane, int shift) {
    GreyImage shifted(plane.size());
    for (int y = 0; y < plane.rows; ++y)
        plane.row(std::clamp(y + shift, 0, plane.rows - 1)).copyTo(shifted.row(y));
    return shifted;
}

GreyImage median_of(const GreyImage& plane) {
    GreyImage median;
    cv::medianBlur(plane, median, 3);
    return median;
}

}  // namespace

StereoPlanes planes_of(const ColourImage& picture) {
    StereoPlanes planes{to_grey(picture), GreyImage(picture.size())};
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols; ++x)
            planes.colour(y, x) =
                static_cast<unsigned char>((picture(y, x)[0] + 256 - picture(y, x)[2]) >> 1);
    return planes;
}

cv::Mat1i feature_words(const StereoPlanes& picture) {
    const GreyImage& luma = picture.luma;
    cv::Mat1i words(luma.size());
    for (int y = 0; y < luma.rows; ++y)
        for (int x = 0; x < luma.cols; ++x) {
            std::uint32_t census = 0, bit = 1;
            for (int dy = -2; dy <= 2; ++dy)
                for (int dx = -3; dx <= 3; ++dx)
                    if (is_census_neighbour(dx, dy)) {
                        if (at_edge_repeated(luma, x + dx, y + dy) >= luma(y, x)) census |= bit;
                        bit <<= 1;
                    }
            const auto level = [](int value, int first_bit) {
                return (static_cast<std::uint32_t>(value) & 31U) << first_bit;
            };
            words(y, x) = static_cast<int>(census | level(sobel(luma, x, y, 0, 1) >> 2, 17) |
                                           level(picture.colour(y, x) >> 1, 22) |
                                           level(sobel(luma, x, y, 1, 0) >> 2, 27));
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
                for (int d = 0; d < std::min(disparities, x + 1); ++d)
                    least = std::min(least,
                                     feature_cost(left_features(y, x), right_features(row, x - d)));
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

StereoPlanes rows_shifted(const StereoPlanes& picture, int shift) {
    return {shifted_plane(picture.luma, shift), shifted_plane(picture.colour, shift)};
}

StereoPlanes guide_of(const StereoPlanes& picture) {
    return {median_of(picture.luma), median_of(picture.colour)};
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

StereoPlanes halved(const StereoPlanes& picture) {
    return {halved(picture.luma), halved(picture.colour)};
}

StereoPlanes with_half_the_rows(const StereoPlanes& picture) {
    const auto mean_of_rows = [](const GreyImage& plane) {
        GreyImage half((plane.rows + 1) / 2, plane.cols);
        for (int y = 0; y < half.rows; ++y)
            for (int x = 0; x < half.cols; ++x)
                half(y, x) = static_cast<unsigned char>(
                    (plane(2 * y, x) + at_edge_repeated(plane, x, 2 * y + 1) + 1) >> 1);
        return half;
    };
    return {mean_of_rows(picture.luma), mean_of_rows(picture.colour)};
}

cv::Mat1b permeability_of(const StereoPlanes& guide, const PermeabilityTable& table) {
    cv::Mat1b result(guide.luma.size());
    const auto passes = [&](int x, int y, int from_x, int from_y) {
        const int luma = std::abs(guide.luma(y, x) - guide.luma(from_y, from_x)),
                  colour = std::abs(guide.colour(y, x) - guide.colour(from_y, from_x));
        return table[static_cast<std::size_t>(std::min(luma + (colour >> 1), 255))];
    };
    for (int y = 0; y < result.rows; ++y)
        for (int x = 0; x < result.cols; ++x) {
            const std::uint32_t left = x > 0 ? passes(x, y, x - 1, y) : 0;
            const std::uint32_t up = y > 0 ? passes(x, y, x, y - 1) : 0;
            result(y, x) = static_cast<unsigned char>(left | (up << 4));
        }
    return result;
}

}  // namespace vantage
