#include "tests/bench/stereo/random_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace vantage {
namespace {

constexpr int supersampling_x = 3, supersampling_y = 2;

/// A tileable colour picture that a surface wears.
cv::Mat3f make_texture(cv::RNG& random, const std::vector<ColourImage>& photographs) {
    constexpr int side = 512;
    cv::Mat3f texture(side, side);
    const int kind = random.uniform(0, 10);
    const cv::Vec3f base(random.uniform(30.f, 220.f), random.uniform(30.f, 220.f),
                         random.uniform(30.f, 220.f));
    if (kind < 4 && !photographs.empty()) {
        const ColourImage& photograph = photographs[static_cast<std::size_t>(
            random.uniform(0, static_cast<int>(photographs.size())))];
        const int crop = std::min({photograph.rows, photograph.cols, random.uniform(200, 600)});
        const cv::Rect part(random.uniform(0, photograph.cols - crop + 1),
                            random.uniform(0, photograph.rows - crop + 1), crop, crop);
        cv::Mat scaled;
        cv::resize(photograph(part), scaled, {side, side}, 0, 0, cv::INTER_AREA);
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                const cv::Vec4b& c = scaled.at<cv::Vec4b>(y, x);
                texture(y, x) = cv::Vec3f(c[0], c[1], c[2]);
            }
        return texture;
    }
    texture.setTo(cv::Scalar(base[0], base[1], base[2]));
    if (kind == 4) return texture;  // plain paint
    if (kind == 5) {                // a repeated pattern
        const int period = random.uniform(5, 24);
        const cv::Vec3f other(random.uniform(30.f, 220.f), random.uniform(30.f, 220.f),
                              random.uniform(30.f, 220.f));
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
                if ((x / period + y / period) % 2) texture(y, x) = other;
    }
    // Noise of several octaves; its strength goes from barely there to loud.
    const float contrast = std::pow(10.0f, random.uniform(0.3f, 1.7f));
    const int finest = random.uniform(0, 3), octaves = random.uniform(1, 6);
    const bool coloured = random.uniform(0, 2) == 1;
    for (int octave = finest; octave < finest + octaves; ++octave) {
        const int cells = std::max(side >> octave, 4);
        cv::Mat noise(cells, cells, coloured ? CV_32FC3 : CV_32FC1);
        random.fill(noise, cv::RNG::UNIFORM, -1.0, 1.0);
        if (!coloured) cv::merge(std::vector<cv::Mat>{noise, noise, noise}, noise);
        cv::Mat large;
        cv::resize(noise, large, {side, side}, 0, 0, cv::INTER_CUBIC);
        texture += large * (contrast * std::pow(1.3f, static_cast<float>(octave - finest)) /
                            std::sqrt(static_cast<float>(octaves)));
    }
    return texture;
}

struct Surface {
    float d0, dx, dy, curvature;  ///< disparity over left coordinates relative to the centre
    float centre_x, centre_y, radius_x, radius_y, angle, exponent;  ///< superellipse
    float texture_scale, texture_angle;
    cv::Mat3f texture;
    bool everywhere = false;

    bool covers(float x, float y) const {
        if (everywhere) return true;
        const float c = std::cos(angle), s = std::sin(angle);
        const float u = (c * (x - centre_x) + s * (y - centre_y)) / radius_x;
        const float v = (-s * (x - centre_x) + c * (y - centre_y)) / radius_y;
        return std::pow(std::abs(u), exponent) + std::pow(std::abs(v), exponent) <= 1;
    }
    float disparity(float x, float y) const {
        const float u = (x - centre_x) / radius_x, v = (y - centre_y) / radius_y;
        return d0 + dx * (x - centre_x) + dy * (y - centre_y) -
               curvature * std::min(u * u + v * v, 2.0f);
    }
    cv::Vec3f colour(float x, float y) const {
        const float c = std::cos(texture_angle) * texture_scale,
                    s = std::sin(texture_angle) * texture_scale;
        const float u = c * x + s * y + 3 * 512, v = -s * x + c * y + 3 * 512;
        const int u0 = static_cast<int>(std::floor(u)), v0 = static_cast<int>(std::floor(v));
        const float fu = u - static_cast<float>(u0), fv = v - static_cast<float>(v0);
        const auto texel = [&](int i, int j) { return texture(j & 511, i & 511); };
        return (texel(u0, v0) * (1 - fu) + texel(u0 + 1, v0) * fu) * (1 - fv) +
               (texel(u0, v0 + 1) * (1 - fu) + texel(u0 + 1, v0 + 1) * fu) * fv;
    }
    /// The left abscissa of the point that the right camera sees at x_right.
    float left_from_right(float x_right, float y) const {
        float x = x_right + d0;
        for (int i = 0; i < 6; ++i) x = x_right + disparity(x, y);
        return x;
    }
};

struct Hit {
    const Surface* surface = nullptr;
    float x_left = 0, disparity = 0;
};

Hit hit(const std::vector<Surface>& surfaces, float x, float y, bool from_right) {
    Hit nearest;
    for (const Surface& surface : surfaces) {
        const float x_left = from_right ? surface.left_from_right(x, y) : x;
        if (!surface.covers(x_left, y)) continue;
        const float d = surface.disparity(x_left, y);
        if (!nearest.surface || d > nearest.disparity) nearest = {&surface, x_left, d};
    }
    return nearest;
}

ColourImage photograph_of(const std::vector<Surface>& surfaces, const RandomSceneLook& look,
                          bool is_right, cv::RNG& random) {
    cv::Mat3f picture(look.height_px, look.width_px);
    for (int y = 0; y < look.height_px; ++y)
        for (int x = 0; x < look.width_px; ++x) {
            cv::Vec3f sum(0, 0, 0);
            for (int j = 0; j < supersampling_y; ++j)
                for (int i = 0; i < supersampling_x; ++i) {
                    const float fx = static_cast<float>(x) +
                                     (static_cast<float>(i) + 0.5f) / supersampling_x - 0.5f;
                    const float fy = static_cast<float>(y) +
                                     (static_cast<float>(j) + 0.5f) / supersampling_y - 0.5f +
                                     (is_right ? static_cast<float>(look.right_shift_y_px) : 0.0f);
                    const Hit at = hit(surfaces, fx, fy, is_right);
                    sum += at.surface->colour(at.x_left, fy);
                }
            picture(y, x) = sum * (1.0f / (supersampling_x * supersampling_y));
        }
    cv::GaussianBlur(picture, picture, {3, 3}, 0.5);
    cv::Mat3f noise(picture.size());
    random.fill(noise, cv::RNG::NORMAL, 0.0, look.noise_sigma);
    if (is_right) picture = picture * look.right_gain + cv::Scalar::all(look.right_offset);
    picture += noise;
    ColourImage result(picture.size());
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols; ++x) {
            const cv::Vec3f& c = picture(y, x);
            result(y, x) = {cv::saturate_cast<unsigned char>(c[0]),
                            cv::saturate_cast<unsigned char>(c[1]),
                            cv::saturate_cast<unsigned char>(c[2]), 255};
        }
    return result;
}

}  // namespace

StereoScene make_random_scene(std::uint64_t seed, const RandomSceneLook& look,
                              const std::vector<ColourImage>& photographs) {
    cv::RNG random(seed * 7919 + 17);
    const float w = static_cast<float>(look.width_px), h = static_cast<float>(look.height_px);
    const float top = static_cast<float>(look.disparities) * 0.9f;
    std::vector<Surface> surfaces;
    const int count = random.uniform(10, 26);
    for (int i = 0; i < count; ++i) {
        Surface s{};
        s.everywhere = i == 0;
        const bool pole = i > 0 && random.uniform(0, 5) == 0;
        const float nearness = i == 0 ? random.uniform(0.12f, 0.3f) : random.uniform(0.25f, 0.9f);
        s.d0 = top * nearness;
        s.centre_x = s.everywhere ? w / 2 : random.uniform(0.f, w);
        s.centre_y = s.everywhere ? h / 2 : random.uniform(0.f, h);
        s.radius_x = s.everywhere
                         ? w
                         : (pole ? random.uniform(1.5f, 5.f) : random.uniform(0.05f, 0.28f) * w);
        s.radius_y = s.everywhere ? h : random.uniform(0.08f, 0.35f) * h;
        const float steepest = 0.1f * top / w;
        s.dx = pole ? 0 : random.uniform(-2 * steepest, 2 * steepest);
        s.dy = random.uniform(-2 * steepest, 2 * steepest);
        s.curvature = random.uniform(0, 3) == 0 && !pole && !s.everywhere
                          ? random.uniform(0.f, 0.06f * top)
                          : 0.f;
        s.angle = random.uniform(-1.5f, 1.5f);
        s.exponent = random.uniform(0, 2) ? 2.0f : 8.0f;
        s.texture_scale = random.uniform(0.4f, 1.5f);
        s.texture_angle = random.uniform(-0.8f, 0.8f);
        s.texture = make_texture(random, photographs);
        surfaces.push_back(std::move(s));
    }

    StereoScene scene;
    scene.name = fmt::format("generated {}", seed);
    scene.disparities = look.disparities;
    scene.use = seed < first_held_out_seed ? SceneUse::tuning : SceneUse::held_out_generated;
    scene.left = photograph_of(surfaces, look, false, random);
    scene.right = photograph_of(surfaces, look, true, random);
    scene.disparity_px = cv::Mat1f(look.height_px, look.width_px);
    scene.non_occluded = cv::Mat1b(look.height_px, look.width_px);
    for (int y = 0; y < look.height_px; ++y)
        for (int x = 0; x < look.width_px; ++x) {
            const float fx = static_cast<float>(x), fy = static_cast<float>(y);
            const Hit left = hit(surfaces, fx, fy, false);
            const float x_right = fx - left.disparity;
            const bool visible =
                x_right >= 0 && hit(surfaces, x_right, fy, true).disparity < left.disparity + 0.5f;
            const bool in_range =
                left.disparity >= 0 && left.disparity < static_cast<float>(look.disparities - 1);
            scene.disparity_px(y, x) =
                in_range ? left.disparity : std::numeric_limits<float>::infinity();
            scene.non_occluded(y, x) = visible && in_range ? 255 : 0;
        }
    return scene;
}

}  // namespace vantage
