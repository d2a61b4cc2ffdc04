#include "common/board/board_view.h"

#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace vantage {

double burnt_out_share(const GreyImage& picture, const std::array<Eigen::Vector2d, 4>& outline) {
    std::vector<cv::Point> corners;
    corners.reserve(outline.size());
    for (const Eigen::Vector2d& p : outline)
        corners.emplace_back(static_cast<int>(std::lround(p.x())),
                             static_cast<int>(std::lround(p.y())));
    const cv::Rect box = cv::boundingRect(corners) & cv::Rect({0, 0}, picture.size());
    if (box.empty()) return 0;
    for (cv::Point& p : corners) p -= box.tl();
    GreyImage inside(box.size(), uchar{0});
    cv::fillConvexPoly(inside, corners, cv::Scalar(255));
    const int pixels = cv::countNonZero(inside);
    inside &= picture(box) >= 254;
    return pixels > 0 ? cv::countNonZero(inside) / static_cast<double>(pixels) : 0;
}

}  // namespace vantage
