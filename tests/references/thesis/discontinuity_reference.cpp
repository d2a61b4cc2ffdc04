#include "tests/references/thesis/discontinuity_reference.h"

#include <algorithm>
#include <cstdlib>

namespace vantage::thesis {

cv::Mat1b discontinuity_reference(const ColourImage& picture, int threshold) {
    const auto is_cut = [&](int x, int y, int x2, int y2) {
        if (x2 < 0 || y2 < 0 || x2 >= picture.cols || y2 >= picture.rows) return true;
        const cv::Vec4b &a = picture(y, x), &b = picture(y2, x2);
        return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])}) >
               threshold;
    };
    cv::Mat1b map(picture.size(), 0);
    for (int y = 0; y < map.rows; ++y)
        for (int x = 0; x < map.cols; ++x) {
            if (is_cut(x, y, x - 1, y)) map(y, x) |= cut_left;
            if (is_cut(x, y, x + 1, y)) map(y, x) |= cut_right;
            if (is_cut(x, y, x, y - 1)) map(y, x) |= cut_above;
            if (is_cut(x, y, x, y + 1)) map(y, x) |= cut_below;
        }
    return map;
}

}  // namespace vantage::thesis
