#include "tests/references/stereo/row_fill_reference.h"

#include <algorithm>
#include <vector>

namespace vantage {

DisparityImage filled_from_background(const DisparityImage& disparity,
                                      const DisparityImage& sources) {
    DisparityImage filled = disparity.clone();
    for (int y = 0; y < filled.rows; ++y) {
        const DisparityImage row =
            cv::countNonZero(sources.row(y)) ? sources.row(y) : disparity.row(y);
        std::vector<unsigned short> right(static_cast<std::size_t>(filled.cols));
        unsigned short known = 0;
        for (int x = filled.cols - 1; x >= 0; --x)
            right[static_cast<std::size_t>(x)] = known = row(0, x) ? row(0, x) : known;
        known = 0;
        for (int x = 0; x < filled.cols; ++x) {
            if (row(0, x)) known = row(0, x);
            if (disparity(y, x)) continue;
            const unsigned short other = right[static_cast<std::size_t>(x)];
            filled(y, x) = known && other ? std::min(known, other) : std::max(known, other);
        }
    }
    return filled;
}

}  // namespace vantage
