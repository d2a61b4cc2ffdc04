#include "tests/references/thesis/snf_reference.h"

#include <algorithm>
#include <cstdlib>

namespace vantage::thesis {
namespace {

int distance(const cv::Vec4b& a, const cv::Vec4b& b) {
    return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
}

}  // namespace

ColourImage snf_reference(const ColourImage& picture) {
    const auto at = [&](int x, int y) -> const cv::Vec4b& {
        return picture(std::clamp(y, 0, picture.rows - 1), std::clamp(x, 0, picture.cols - 1));
    };
    constexpr int offsets[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
    ColourImage filtered(picture.size());
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols; ++x) {
            const cv::Vec4b& centre = picture(y, x);
            cv::Vec3i sum(0, 0, 0);
            for (const auto& [dx, dy] : offsets) {
                const cv::Vec4b& a = at(x + dx, y + dy);
                const cv::Vec4b& b = at(x - dx, y - dy);
                const cv::Vec4b& kept = distance(a, centre) <= distance(b, centre) ? a : b;
                sum += cv::Vec3i(kept[0], kept[1], kept[2]);
            }
            for (int c = 0; c < 3; ++c)
                filtered(y, x)[c] = static_cast<unsigned char>((sum[c] + 2) / 4);
            filtered(y, x)[3] = 255;
        }
    return filtered;
}

}  // namespace vantage::thesis
