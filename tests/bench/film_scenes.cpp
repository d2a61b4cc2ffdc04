#include "tests/bench/film_scenes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <opencv2/imgproc.hpp>

#include "common/base/error.h"

namespace vantage {
namespace {

using Colour = cv::Vec3d;  // R, G, B, 0..1

constexpr int drawn_width_px = 480, drawn_height_px = 360;       // the scenes' own pixels
constexpr double wall_px = 12, floor_px = 24, horizon_px = 235;  // disparities and the floor's edge
constexpr double lens_sigma_px = 0.6;
constexpr int sub_pixels = 3;

double hash(int x, int y, std::uint32_t seed) {
    std::uint32_t h = seed * 0x9e3779b9u + static_cast<std::uint32_t>(x) * 0x85ebca6bu +
                      static_cast<std::uint32_t>(y) * 0xc2b2ae35u;
    h ^= h >> 15;
    h *= 0x2c1b3c6du;
    h ^= h >> 12;
    h *= 0x297a2d39u;
    h ^= h >> 15;
    return h / 4294967296.0;
}

/// Smooth noise, 0..1, with cells of one unit.
double noise(double x, double y, std::uint32_t seed) {
    const int ix = static_cast<int>(std::floor(x)), iy = static_cast<int>(std::floor(y));
    const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
    const double fx = smooth(x - ix), fy = smooth(y - iy);
    const double top = hash(ix, iy, seed) * (1 - fx) + hash(ix + 1, iy, seed) * fx;
    const double bottom = hash(ix, iy + 1, seed) * (1 - fx) + hash(ix + 1, iy + 1, seed) * fx;
    return top * (1 - fy) + bottom * fy;
}

/// Around 0, with detail at several sizes.
double texture(double x, double y, std::uint32_t seed) {
    return 0.5 * noise(x / 23, y / 23, seed) + 0.3 * noise(x / 7, y / 7, seed + 1) +
           0.2 * noise(x / 2.6, y / 2.6, seed + 2) - 0.5;
}

double background_disparity_px(double y) {
    const double below = (y - horizon_px) / (drawn_height_px - horizon_px);
    return wall_px + (floor_px - wall_px) * std::clamp(below, 0.0, 1.0);
}

Colour background_colour(FilmScene scene, double x, double y) {
    const double detail = texture(x, y, 11);
    const bool is_belt = y > 150 && y < 300;
    if (scene == FilmScene::white) return Colour(0.93, 0.93, 0.92) + Colour::all(0.05 * detail);
    if (is_belt && scene == FilmScene::brown)
        return Colour(0.45, 0.31, 0.21) + Colour::all(0.10 * detail);
    if (is_belt && scene == FilmScene::box)
        return Colour(0.16, 0.26, 0.55) + Colour::all(0.08 * detail);
    return Colour(0.52, 0.50, 0.45) + Colour(0.55, 0.5, 0.4) * detail;
}

/// A flat thing that faces the cameras.
struct Performer {
    double x, y, half_width, half_height, turn_rad, disparity_px;
    Colour colour;
    double detail;
    std::uint32_t seed;

    bool holds(double at_x, double at_y, double& u, double& v) const {
        const double dx = at_x - x, dy = at_y - y, c = std::cos(turn_rad), s = std::sin(turn_rad);
        u = c * dx + s * dy;
        v = c * dy - s * dx;
        return std::abs(u) < half_width && std::abs(v) < half_height;
    }
};

/// From the farthest to the nearest.
std::array<Performer, 2> performers_of(FilmScene scene, double t) {
    Performer body{150 + 60 * t,       215,  34, 62, 0.12 * std::sin(3 * t), 19,
                   {0.43, 0.28, 0.18}, 0.03, 31};
    Performer hand{body.x + 70 * std::cos(2.2 * t),
                   190 + 30 * std::sin(3.1 * t),
                   44,
                   9,
                   0.9 * std::sin(2.7 * t),
                   21,
                   {0.80, 0.58, 0.47},
                   0.05,
                   37};
    switch (scene) {
        case FilmScene::box:
            break;
        case FilmScene::brown:
            body.colour = Colour(0.50, 0.34, 0.22);
            hand.colour = Colour(0.56, 0.40, 0.29);
            break;
        case FilmScene::white:
            body.colour = Colour(0.88, 0.88, 0.88);
            hand.colour = Colour(0.98, 0.97, 0.96);
            break;
        case FilmScene::leaves:
        case FilmScene::drift:
            body.colour = Colour(0.6, 0.25, 0.3);
            body.detail = 0.5;
            hand.detail = 0.2;
            break;
    }
    return {body, hand};
}

/// What light and shadow make of a place on the background, 0..1.
double light_on(FilmScene scene, double x, double y, double t) {
    if (scene != FilmScene::leaves) return 1;
    const double sway = 14 * std::sin(2.4 * t);
    const double leaves = noise((x + sway + 8 * t) / 26, (y + 0.4 * sway) / 18, 71);
    return leaves > 0.62 ? 0.30 : 1.0;
}

Colour gain_at(FilmScene scene, double t) {
    if (scene != FilmScene::drift) return Colour::all(1);
    return Colour(1 + 0.10 * std::sin(2.1 * t), 1 + 0.09 * std::sin(2.1 * t + 0.2),
                  1 + 0.12 * std::sin(2.1 * t - 0.3));
}

struct ScenePoint {
    Colour colour;
    bool is_performer, is_lit_anew;
};

/// At a place of a camera's picture, in the scene's own pixels.
ScenePoint look_at_scene(FilmScene scene, double t, double baselines, double x, double y) {
    const auto performers = performers_of(scene, t);
    for (auto it = performers.rbegin(); it != performers.rend(); ++it) {
        double u = 0, v = 0;
        if (it->holds(x + baselines * it->disparity_px, y, u, v))
            return {it->colour + Colour::all(it->detail * texture(u + 500, v + 500, it->seed)),
                    true, false};
    }
    const double left_x = x + baselines * background_disparity_px(y);
    const double light = light_on(scene, left_x, y, t);
    return {light * background_colour(scene, left_x, y), false, light < 1};
}

}  // namespace

const char* words_of(FilmScene scene) {
    switch (scene) {
        case FilmScene::box:
            return "box";
        case FilmScene::brown:
            return "brown";
        case FilmScene::white:
            return "white";
        case FilmScene::leaves:
            return "leaves";
        case FilmScene::drift:
            return "drift";
    }
    return "";
}

FilmScene parse_film_scene(const std::string& text) {
    std::string all;
    for (const FilmScene scene : all_film_scenes) {
        if (text == words_of(scene)) return scene;
        all += std::string(all.empty() ? "" : ", ") + words_of(scene);
    }
    fail("there is no film '{}'; choose one of {}", text, all);
}

SceneCamera scene_camera(cv::Size size) { return {1.05 * size.width, 0.1}; }

SceneFrame film_scene(FilmScene scene, double time_s, double baselines, cv::Size size) {
    const double scale_x = static_cast<double>(drawn_width_px) / size.width;
    const double scale_y = static_cast<double>(drawn_height_px) / size.height;
    cv::Mat3f colour(size);
    SceneFrame frame{{}, cv::Mat1b(size), cv::Mat1b(size)};
    const Colour gain = gain_at(scene, time_s);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            Colour sum;
            int performers = 0, lit_anew = 0;
            for (int k = 0; k < sub_pixels * sub_pixels; ++k) {
                const double at_x = x + (k % sub_pixels + 0.5) / sub_pixels;
                const double at_y = y + (k / sub_pixels + 0.5) / sub_pixels;
                const ScenePoint point =
                    look_at_scene(scene, time_s, baselines, scale_x * at_x, scale_y * at_y);
                sum += point.colour;
                performers += point.is_performer;
                lit_anew += point.is_lit_anew;
            }
            colour(y, x) = (255.0 / (sub_pixels * sub_pixels)) * sum.mul(gain);
            frame.performers(y, x) = performers > 0 ? 255 : 0;
            frame.moving(y, x) = performers > 0 || lit_anew > 0 ? 255 : 0;
        }
    cv::GaussianBlur(colour, colour, {}, lens_sigma_px);
    cv::Mat bytes;
    colour.convertTo(bytes, CV_8U);
    cv::cvtColor(bytes, frame.colour, cv::COLOR_RGB2RGBA);
    return frame;
}

}  // namespace vantage
