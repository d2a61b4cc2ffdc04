#include "common/colour/colour_correction.h"

#include <array>
#include <cmath>

#include "common/base/error.h"

namespace vantage {

void ColourCorrection::validate() const {
    constexpr double largest = 10, least_tone = 0.2, most_tone = 5;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
            if (!(std::abs(matrix(r, c)) <= largest))
                fail("the colour matrix has {} in row {}, column {}; entries are -{} to {}",
                     matrix(r, c), r + 1, c + 1, largest, largest);
    for (int c = 0; c < 3; ++c)
        if (!(tone[c] >= least_tone && tone[c] <= most_tone))
            fail("the tone of channel {} is {}; it must be {} to {}", c + 1, tone[c], least_tone,
                 most_tone);
}

Eigen::Vector3d ColourCorrection::apply(const Eigen::Vector3d& coded) const {
    Eigen::Vector3d linear;
    for (int c = 0; c < 3; ++c) linear[c] = std::pow(srgb_decode(coded[c]), tone[c]);
    Eigen::Vector3d stage = matrix * linear;
    for (int c = 0; c < 3; ++c) stage[c] = srgb_encode(std::min(1.0, std::max(0.0, stage[c])));
    return stage;
}

ColourImage ColourCorrection::apply(const ColourImage& picture) const {
    std::array<std::array<double, 256>, 3> linear{};
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t v = 0; v < 256; ++v)
            linear[c][v] = std::pow(srgb_decode(static_cast<double>(v) / 255),
                                    tone[static_cast<Eigen::Index>(c)]);
    ColourImage corrected(picture.size());
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols; ++x) {
            const cv::Vec4b& in = picture(y, x);
            const Eigen::Vector3d stage =
                matrix * Eigen::Vector3d(linear[0][in[0]], linear[1][in[1]], linear[2][in[2]]);
            cv::Vec4b& out = corrected(y, x);
            for (int c = 0; c < 3; ++c)
                out[c] = cv::saturate_cast<uchar>(
                    255 * srgb_encode(std::min(1.0, std::max(0.0, stage[c]))));
            out[3] = in[3];
        }
    return corrected;
}

}  // namespace vantage
