#include "tests/references/stereo/median_reference.h"

#include <algorithm>
#include <array>

namespace vantage {

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
