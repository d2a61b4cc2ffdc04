#include "rig_firmware/stereo/passes/fill_reference.h"

#include <algorithm>
#include <array>
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

DisparityImage median_of_known(const DisparityImage& disparity) {
    DisparityImage result(disparity.size(), 0);
    for (int y = 0; y < disparity.rows; ++y)
        for (int x = 0; x < disparity.cols; ++x) {
            const unsigned short centre = disparity(y, x);
            if (!centre) continue;
            std::array<unsigned short, 9> votes{};
            std::size_t count = 0;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    const unsigned short vote =
                        disparity(std::clamp(y + dy, 0, disparity.rows - 1),
                                  std::clamp(x + dx, 0, disparity.cols - 1));
                    votes[count++] = vote ? vote : centre;
                }
            std::ranges::nth_element(votes, votes.begin() + 4);
            result(y, x) = votes[4];
        }
    return result;
}

}  // namespace vantage
