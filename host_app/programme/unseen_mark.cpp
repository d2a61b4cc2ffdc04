#include "host_app/programme/unseen_mark.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

#include "host_app/synthesis/synthesiser.h"

namespace vantage {
namespace {

/// Distances are measured on a coarse grid, which is fast.
constexpr int cells_a_row = 80;
constexpr float first_cells = cells_a_row / 20.0f, last_cells = cells_a_row / 10.0f;
constexpr int stripes_a_row = 60;
const cv::Vec3f dark(26, 28, 32), light(44, 47, 53);

bool is_unseen(const cv::Vec4b& pixel) {
    constexpr unsigned char min_seen = 128;
    return pixel[3] < min_seen && pixel[3] != remembered_alpha;
}

/// Distances to the nearest pixel that was seen, in cells.
cv::Mat1f distances_to_seen(const ColourImage& picture, int cell_px) {
    cv::Mat1b unseen((picture.rows + cell_px - 1) / cell_px,
                     (picture.cols + cell_px - 1) / cell_px);
    for (int y = 0; y < unseen.rows; ++y)
        for (int x = 0; x < unseen.cols; ++x)
            unseen(y, x) = is_unseen(picture(std::min(y * cell_px + cell_px / 2, picture.rows - 1),
                                             std::min(x * cell_px + cell_px / 2, picture.cols - 1)))
                               ? 255
                               : 0;
    cv::Mat1f distances;
    cv::distanceTransform(unseen, distances, cv::DIST_L2, 3);
    return distances;
}

}  // namespace

void mark_unseen(ColourImage& picture) {
    if (picture.empty()) return;
    const int cell_px = std::max(1, picture.cols / cells_a_row);
    const cv::Mat1f distances = distances_to_seen(picture, cell_px);
    double farthest = 0;
    cv::minMaxLoc(distances, nullptr, &farthest);
    if (farthest <= first_cells) return;
    cv::Mat1f shares = (distances - first_cells) / (last_cells - first_cells);
    cv::resize(shares, shares, {}, cell_px, cell_px, cv::INTER_LINEAR);
    const int stripe_px = std::max(2, picture.cols / stripes_a_row);
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols; ++x) {
            cv::Vec4b& pixel = picture(y, x);
            const float share = std::min(1.0f, shares(y, x));
            if (share <= 0 || !is_unseen(pixel)) continue;
            const cv::Vec3f& mark = (x + y) / stripe_px % 2 == 0 ? dark : light;
            for (int i = 0; i < 3; ++i)
                pixel[i] =
                    cv::saturate_cast<unsigned char>((1 - share) * pixel[i] + share * mark[i]);
        }
}

}  // namespace vantage
