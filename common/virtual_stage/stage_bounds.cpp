#include "common/virtual_stage/stage_bounds.h"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

constexpr int square_px = 8;

int squares_over(int length_px) { return (length_px + square_px - 1) / square_px; }

}  // namespace

ScreenBounds::ScreenBounds(const StageCamera& camera)
    : K_(camera.K.cast<float>()),
      camera_from_world_(camera.world_from_camera.inverse().matrix().cast<float>()),
      picture_(0, 0, camera.width_px, camera.height_px) {}

cv::Rect ScreenBounds::of(std::span<const Eigen::Vector3f> points_m) const {
    constexpr float nearest_m = 0.1f;
    // The spread of a sample: 1.25 pixels to each side.
    constexpr float margin_px = 2;
    Eigen::Array2f low(1e9f, 1e9f), high(-1e9f, -1e9f);
    for (const Eigen::Vector3f& point : points_m) {
        const Eigen::Vector3f p = camera_from_world_ * point;
        if (p.z() < nearest_m) return picture_;
        const Eigen::Array2f at = (K_.topRows<2>() * p / p.z()).array();
        low = low.min(at);
        high = high.max(at);
    }
    const auto pixel = [](float at) {
        return static_cast<int>(std::floor(std::clamp(at, -1e5f, 1e5f)));
    };
    return cv::Rect(cv::Point(pixel(low.x() - margin_px), pixel(low.y() - margin_px)),
                    cv::Point(pixel(high.x() + margin_px) + 1, pixel(high.y() + margin_px) + 1)) &
           picture_;
}

PictureParts::PictureParts(cv::Size picture)
    : picture_({}, picture),
      squares_(squares_over(picture.height), squares_over(picture.width), uchar{0}) {}

void PictureParts::add(const cv::Rect& part) { squares_(squares_of(part)) = uchar{255}; }

bool PictureParts::holds_any_of(const cv::Rect& part) const {
    const cv::Rect squares = squares_of(part);
    for (int y = squares.y; y < squares.br().y; ++y)
        for (int x = squares.x; x < squares.br().x; ++x)
            if (squares_(y, x) != 0) return true;
    return false;
}

cv::Rect PictureParts::squares_of(const cv::Rect& part) const {
    const cv::Rect within = part & picture_;
    if (within.empty()) return {};
    return {cv::Point(within.x / square_px, within.y / square_px),
            cv::Point(squares_over(within.br().x), squares_over(within.br().y))};
}

std::vector<cv::Rect> PictureParts::rectangles() const {
    std::vector<cv::Rect> found;
    std::vector<cv::Rect> above;  // rectangles that end with the previous row
    for (int y = 0; y < squares_.rows; ++y) {
        std::vector<cv::Rect> ending;
        for (int x = 0; x < squares_.cols; ++x) {
            if (squares_(y, x) == 0) continue;
            const int from = x;
            while (x < squares_.cols && squares_(y, x) != 0) ++x;
            cv::Rect run(from, y, x - from, 1);
            const auto longer = std::find_if(above.begin(), above.end(), [&](const cv::Rect& r) {
                return r.x == run.x && r.width == run.width;
            });
            if (longer != above.end()) {
                run = *longer | run;
                above.erase(longer);
            }
            ending.push_back(run);
        }
        found.insert(found.end(), above.begin(), above.end());
        above = ending;
    }
    found.insert(found.end(), above.begin(), above.end());
    for (cv::Rect& r : found)
        r = cv::Rect(r.x * square_px, r.y * square_px, r.width * square_px, r.height * square_px) &
            picture_;
    return found;
}

}  // namespace vantage
