#include "tests/support/boards/rendered_board.h"

#include <algorithm>
#include <cmath>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "calib_tools/board/board_drawing.h"
#include "common/geometry/opencv_bridge.h"

namespace vantage {
namespace {

constexpr int square_texels = 40, samples_per_side = 4;
constexpr double black = 32, white = 208, surroundings = 110;

/// Half the difference of the neighbours; the one-sided difference at the border.
cv::Mat2d slope_of(const cv::Mat2d& values, int dx, int dy) {
    cv::Mat2d slope(values.size());
    for (int y = 0; y < values.rows; ++y)
        for (int x = 0; x < values.cols; ++x) {
            const cv::Point a(std::max(0, x - dx), std::max(0, y - dy));
            const cv::Point b(std::min(values.cols - 1, x + dx), std::min(values.rows - 1, y + dy));
            slope(y, x) = (values(b) - values(a)) / std::max(1, (b - a).x + (b - a).y);
        }
    return slope;
}

}  // namespace

BoardCamera::BoardCamera(const std::vector<BoardPattern>& patterns, const CameraModel& camera)
    : patterns_(patterns), camera_(camera), rays_(camera.height_px, camera.width_px) {
    for (const BoardPattern& pattern : patterns)
        pictures_.push_back(draw_board(pattern, square_texels));
    for (int y = 0; y < rays_.rows; ++y)
        for (int x = 0; x < rays_.cols; ++x) rays_(y, x) = cv::Vec2d(x, y);
    const cv::Mat2d pixels = rays_.reshape(2, static_cast<int>(rays_.total())).clone();
    cv::Mat2d slopes;
    cv::undistortPoints(
        pixels, slopes, cv::Mat(to_cv(camera.K())), camera.distortion, cv::noArray(), cv::noArray(),
        cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 30, 1e-9));
    rays_ = slopes.reshape(2, rays_.rows).clone();
    rays_dx_ = slope_of(rays_, 1, 0);
    rays_dy_ = slope_of(rays_, 0, 1);
}

cv::Rect BoardCamera::extent(const PlacedBoard& placed) const {
    const BoardPattern& pattern = patterns_[placed.board];
    const double margin = board_margin_m(pattern) + pattern.square_m;
    const Eigen::Vector3d last = pattern.corner_m(pattern.corner_count() - 1);
    double x0 = camera_.width_px, x1 = 0, y0 = camera_.height_px, y1 = 0;
    constexpr int steps = 16;
    for (int i = 0; i <= steps; ++i)
        for (int k = 0; k <= steps; ++k) {
            const Eigen::Vector3d p(-margin + (last.x() + 2 * margin) * i / steps,
                                    -margin + (last.y() + 2 * margin) * k / steps, 0);
            const auto pixel = camera_.project(placed.camera_from_board * p);
            if (!pixel) return {0, 0, camera_.width_px, camera_.height_px};
            x0 = std::min(x0, pixel->x());
            x1 = std::max(x1, pixel->x());
            y0 = std::min(y0, pixel->y());
            y1 = std::max(y1, pixel->y());
        }
    constexpr double border_px = 4;
    const cv::Rect whole(0, 0, camera_.width_px, camera_.height_px);
    const cv::Point from(static_cast<int>(std::floor(x0 - border_px)),
                         static_cast<int>(std::floor(y0 - border_px)));
    const cv::Point to(static_cast<int>(std::ceil(x1 + border_px)),
                       static_cast<int>(std::ceil(y1 + border_px)));
    return cv::Rect(from, to) & whole;
}

GreyImage BoardCamera::film(const Pose& camera_from_board, const PictureFaults& faults,
                            std::uint64_t seed) const {
    return film({PlacedBoard{0, camera_from_board}}, faults, seed);
}

GreyImage BoardCamera::film(const std::vector<PlacedBoard>& boards, const PictureFaults& faults,
                            std::uint64_t seed) const {
    /// A board's plane, for intersection with rays (x, y, 1).
    struct Plane {
        const GreyImage& picture;
        Eigen::Matrix3d texel_from_ray;  ///< the inverse of [r1 r2 t], then the board's scale
        cv::Rect part;
        bool from_behind;
    };
    std::vector<Plane> planes;
    for (const PlacedBoard& placed : boards) {
        const BoardPattern& pattern = patterns_[placed.board];
        const Pose& pose = placed.camera_from_board;
        Eigen::Matrix3d ray_from_plane;
        ray_from_plane << pose.linear().col(0), pose.linear().col(1), pose.translation();
        const double scale = square_texels / pattern.square_m;
        const double origin = (board_margin_m(pattern) + pattern.square_m) * scale;
        Eigen::Matrix3d texel_from_plane;
        texel_from_plane << scale, 0, origin, 0, scale, origin, 0, 0, 1;
        planes.push_back({pictures_[placed.board], texel_from_plane * ray_from_plane.inverse(),
                          extent(placed), pose.linear().col(2).dot(pose.translation()) < 0});
    }
    const auto light_along = [&](const cv::Vec2d& ray, const cv::Point& pixel) {
        double value = surroundings, nearest = 0;
        for (const Plane& plane : planes) {
            if (!plane.part.contains(pixel)) continue;
            const Eigen::Vector3d t = plane.texel_from_ray * Eigen::Vector3d(ray[0], ray[1], 1);
            // 1 / depth; its sign distinguishes boards in front of the camera from those behind it.
            if (!(t.z() > nearest)) continue;
            const double u = t.x() / t.z(), v = t.y() / t.z();
            if (!(u >= 0 && v >= 0 && u < plane.picture.cols && v < plane.picture.rows)) continue;
            nearest = t.z();
            const bool is_white = plane.picture(static_cast<int>(v), static_cast<int>(u)) > 0;
            value = plane.from_behind ? surroundings : is_white ? white : black;
        }
        return value;
    };
    cv::Mat1f light(camera_.height_px, camera_.width_px, static_cast<float>(surroundings));
    cv::Rect part;
    for (const Plane& plane : planes) part |= plane.part;
    for (int y = part.y; y < part.br().y; ++y)
        for (int x = part.x; x < part.br().x; ++x) {
            const cv::Vec2d middle = rays_(y, x), dx = rays_dx_(y, x), dy = rays_dy_(y, x);
            const auto sample = [&](int i, int j) {
                return light_along(middle + ((i + 0.5) / samples_per_side - 0.5) * dx +
                                       ((j + 0.5) / samples_per_side - 0.5) * dy,
                                   {x, y});
            };
            // There is no edge among samples whose outermost four are equal.
            constexpr int last = samples_per_side - 1;
            const double first = sample(0, 0);
            if (sample(last, 0) == first && sample(0, last) == first &&
                sample(last, last) == first) {
                light(y, x) = static_cast<float>(first);
                continue;
            }
            double sum = 0;
            for (int j = 0; j < samples_per_side; ++j)
                for (int i = 0; i < samples_per_side; ++i) sum += sample(i, j);
            light(y, x) = static_cast<float>(sum / (samples_per_side * samples_per_side));
        }
    if (faults.blur_px > 0)
        cv::GaussianBlur(light, light, {}, faults.blur_px, faults.blur_px, cv::BORDER_REPLICATE);
    if (faults.glare > 0 && !boards.empty()) {
        const BoardPattern& pattern = patterns_[boards.front().board];
        const int width_px = planes.front().part.width;
        cv::Mat1f spot(light.size(), 0.0f);
        const auto middle = camera_.project(boards.front().camera_from_board *
                                            (0.5 * pattern.corner_m(pattern.corner_count() - 1)));
        if (middle)
            cv::circle(spot,
                       {static_cast<int>(std::lround(middle->x())),
                        static_cast<int>(std::lround(middle->y()))},
                       static_cast<int>(std::lround(0.5 * faults.glare * width_px)),
                       cv::Scalar(400), cv::FILLED);
        cv::GaussianBlur(spot, spot, {}, 0.06 * width_px);
        light += spot;
    }
    cv::Mat1f noise(light.size());
    cv::RNG random(seed);
    random.fill(noise, cv::RNG::NORMAL, 0, faults.noise_sigma);
    for (int y = 0; y < light.rows; ++y)
        for (int x = 0; x < light.cols; ++x)
            light(y, x) *= static_cast<float>(1 - faults.light_slope * x / light.cols);
    light += noise;
    GreyImage picture;
    light.convertTo(picture, CV_8U);
    return picture;
}

}  // namespace vantage
