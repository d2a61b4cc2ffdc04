#include "common/virtual_stage/stage_textures.h"

#include <cmath>

#include <opencv2/imgproc.hpp>

namespace vantage {
namespace {

constexpr int side = stage_texture_side_px;
using Picture = cv::Mat3f;  // colours 0..1

/// Smooth noise around 0 that tiles, with `cells` bumps per side.
cv::Mat1f noise_octave(cv::RNG& random, int cells_x, int cells_y) {
    cv::Mat1f lattice(cells_y, cells_x);
    random.fill(lattice, cv::RNG::UNIFORM, -1.0, 1.0);
    // A wrapped border makes the enlarged lattice continuous across the edges.
    constexpr int border = 2;
    cv::Mat1f wrapped;
    cv::copyMakeBorder(lattice, wrapped, border, border, border, border, cv::BORDER_WRAP);
    const int scale_x = side / cells_x, scale_y = side / cells_y;
    cv::Mat1f large;
    cv::resize(wrapped, large, {}, scale_x, scale_y, cv::INTER_CUBIC);
    return large(cv::Rect(border * scale_x, border * scale_y, side, side)).clone();
}

/// Octaves from `first_cells` down to single texels; each finer one has `gain` times the amplitude.
cv::Mat1f fractal_noise(cv::RNG& random, int first_cells, float gain = 0.6f) {
    cv::Mat1f sum(side, side, 0.0f);
    float amplitude = 1, total = 0;
    for (int cells = first_cells; cells <= side; cells *= 2) {
        sum += amplitude * noise_octave(random, cells, cells);
        total += amplitude;
        amplitude *= gain;
    }
    return sum / total;
}

Picture flat(const cv::Scalar& colour) {
    return Picture(side, side, cv::Vec3f(colour[0], colour[1], colour[2]));
}

void shade(Picture& picture, const cv::Mat1f& by, float strength) {
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) picture(y, x) *= 1 + strength * by(y, x);
}

cv::Scalar vivid(cv::RNG& random) {
    cv::Mat3f hsv(1, 1,
                  cv::Vec3f(random.uniform(0.0f, 360.0f), random.uniform(0.45f, 0.85f),
                            random.uniform(0.55f, 0.95f)));
    cv::Mat3f rgb;
    cv::cvtColor(hsv, rgb, cv::COLOR_HSV2RGB);
    return {rgb(0, 0)[0], rgb(0, 0)[1], rgb(0, 0)[2]};
}

/// Draws at four times the size and scales down, so that edges are antialiased.
template <class Draw>
Picture drawn(const cv::Scalar& background, Draw draw) {
    constexpr int oversampling = 4;
    cv::Mat canvas(side * oversampling, side * oversampling, CV_8UC3, background * 255);
    draw(canvas);
    cv::Mat small;
    cv::resize(canvas, small, {side, side}, 0, 0, cv::INTER_AREA);
    Picture picture;
    small.convertTo(picture, CV_32FC3, 1.0 / 255);
    return picture;
}

Picture draw_wood(cv::RNG& random) {
    // Planks run along x; grain is noise stretched along them.
    constexpr int planks = 8, plank_px = side / planks;
    Picture picture = flat({0.74, 0.53, 0.34});
    const cv::Mat1f fine = noise_octave(random, 16, 256) + 0.6f * noise_octave(random, 32, 512);
    const cv::Mat1f broad = fractal_noise(random, 8);
    std::vector<float> tones(planks), joints(planks);
    for (int p = 0; p < planks; ++p) {
        tones[static_cast<std::size_t>(p)] = random.uniform(0.72f, 1.12f);
        joints[static_cast<std::size_t>(p)] = random.uniform(0.0f, static_cast<float>(side));
    }
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const auto plank = static_cast<std::size_t>(y / plank_px);
            float tone = tones[plank] * (1 + 0.16f * fine(y, x) + 0.22f * broad(y, x));
            const int across = y % plank_px;
            if (across < 2) tone *= 0.55f;
            if (std::abs(static_cast<float>(x) - joints[plank]) < 1.5f) tone *= 0.6f;
            picture(y, x) *= tone;
        }
    return picture;
}

Picture draw_carpet(cv::RNG& random) {
    // A lattice of diamonds, each with a dot. Near ones have different colours, so that a matcher
    // can distinguish them.
    constexpr float pi = 3.14159265f;
    constexpr int cells = 8;
    const cv::Mat1f waves = fractal_noise(random, 4);
    std::vector<cv::Vec3f> grounds, dots;
    for (int i = 0; i < 2 * cells * cells; ++i) {
        const float tone = random.uniform(0.6f, 1.25f);
        grounds.push_back(tone * cv::Vec3f(0.55f + random.uniform(-0.12f, 0.15f),
                                           0.15f + random.uniform(-0.05f, 0.15f),
                                           0.20f + random.uniform(-0.08f, 0.15f)));
        dots.push_back(i % 3 == 0 ? cv::Vec3f(0.20f, 0.42f, 0.50f)
                                  : cv::Vec3f(0.88f, 0.70f, 0.40f));
    }
    Picture picture(side, side);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const float u = cells * static_cast<float>(x) / side,
                        v = cells * static_cast<float>(y) / side;
            // Diagonal cells; those past the middle belong to the next tile.
            const float p = u + v, q = u - v + cells;
            int a = static_cast<int>(p), b = static_cast<int>(q);
            if (a >= cells) {
                a -= cells;
                b += cells;
            }
            const int cell = a * 2 * cells + b % (2 * cells);
            const float edge = std::abs(std::sin(pi * p) * std::sin(pi * q));
            const float uneven = 0.12f * waves(y, x);
            cv::Vec3f colour = grounds.at(static_cast<std::size_t>(cell));
            if (edge > 0.80f + uneven) colour = dots.at(static_cast<std::size_t>(cell));
            if (edge < 0.20f + uneven) colour = {0.84f, 0.64f, 0.34f};
            picture(y, x) = colour;
        }
    shade(picture, noise_octave(random, 256, 256), 0.22f);
    shade(picture, waves, 0.45f);
    return picture;
}

Picture draw_checker(cv::RNG& random) {
    Picture picture(side, side);
    constexpr int cell = side / 8;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            picture(y, x) = (x / cell + y / cell) % 2 ? cv::Vec3f(0.86f, 0.85f, 0.82f)
                                                      : cv::Vec3f(0.23f, 0.26f, 0.32f);
    shade(picture, fractal_noise(random, 8, 0.75f), 0.35f);
    return picture;
}

Picture draw_brick(cv::RNG& random) {
    constexpr int rows = 16, columns = 8, row_px = side / rows, column_px = side / columns;
    Picture picture(side, side);
    cv::Mat1f tones(rows, columns), hues(rows, columns);
    random.fill(tones, cv::RNG::UNIFORM, 0.65, 1.15);
    random.fill(hues, cv::RNG::UNIFORM, 0.0, 1.0);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const int row = y / row_px, shifted = (x + (row % 2) * column_px / 2) % side;
            const int column = shifted / column_px;
            const bool mortar = y % row_px < 3 || shifted % column_px < 3;
            const float hue = hues(row, column);
            picture(y, x) = mortar ? cv::Vec3f(0.70f, 0.67f, 0.62f)
                                   : cv::Vec3f(0.66f, 0.34f + 0.10f * hue, 0.26f + 0.08f * hue) *
                                         tones(row, column);
        }
    shade(picture, fractal_noise(random, 16, 0.8f), 0.35f);
    return picture;
}

Picture draw_plaid(cv::RNG& random) {
    const auto band = [](int at, int period, int width) {
        return at % period < width ? 1.0f : 0.0f;
    };
    Picture picture(side, side);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            cv::Vec3f c(0.78f, 0.24f, 0.20f);
            c +=
                0.5f * (band(x, 128, 48) + band(y, 128, 48)) * (cv::Vec3f(0.16f, 0.18f, 0.34f) - c);
            if (band(x + 40, 128, 6) + band(y + 40, 128, 6) > 0) c = {0.93f, 0.85f, 0.60f};
            picture(y, x) = c;
        }
    shade(picture, noise_octave(random, 256, 256), 0.15f);
    return picture;
}

Picture draw_stripes(cv::RNG& random) {
    Picture picture(side, side);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const int band = (y * 12 / side) % 4;
            picture(y, x) = band == 0   ? cv::Vec3f(0.95f, 0.94f, 0.90f)
                            : band == 1 ? cv::Vec3f(0.13f, 0.30f, 0.52f)
                            : band == 2 ? cv::Vec3f(0.95f, 0.94f, 0.90f)
                                        : cv::Vec3f(0.90f, 0.42f, 0.28f);
        }
    shade(picture, fractal_noise(random, 16, 0.8f), 0.22f);
    return picture;
}

Picture draw_flowers(cv::RNG& random) {
    Picture picture = drawn({0.10, 0.42, 0.45}, [&](cv::Mat& canvas) {
        const int n = canvas.cols;
        for (int i = 0; i < 90; ++i) {
            const cv::Point centre(random.uniform(0, n), random.uniform(0, n));
            const int petal = random.uniform(n / 60, n / 22);
            const cv::Scalar colour = vivid(random) * 255;
            // Drawn once for every neighbouring tile, so that the pattern tiles.
            for (int dy = -n; dy <= n; dy += n)
                for (int dx = -n; dx <= n; dx += n) {
                    const cv::Point at = centre + cv::Point(dx, dy);
                    for (int k = 0; k < 5; ++k) {
                        const double angle = 1.2566 * k + 0.7 * i;
                        const cv::Point offset(static_cast<int>(petal * std::cos(angle)),
                                               static_cast<int>(petal * std::sin(angle)));
                        cv::circle(canvas, at + offset, petal * 3 / 4, colour, cv::FILLED);
                    }
                    cv::circle(canvas, at, petal / 2, {250, 225, 120}, cv::FILLED);
                }
        }
    });
    shade(picture, fractal_noise(random, 32, 0.9f), 0.2f);
    return picture;
}

Picture draw_denim(cv::RNG& random) {
    Picture picture = flat({0.22, 0.33, 0.52});
    shade(picture, noise_octave(random, 128, 512), 0.30f);
    shade(picture, fractal_noise(random, 4, 0.8f), 0.45f);
    return picture;
}

Picture draw_poster_shapes(cv::RNG& random) {
    Picture picture = drawn({0.95, 0.90, 0.78}, [&](cv::Mat& canvas) {
        const int n = canvas.cols;
        for (int i = 0; i < 46; ++i) {
            const cv::Point centre(random.uniform(0, n), random.uniform(0, n));
            const int size = random.uniform(n / 40, n / 7);
            const cv::Scalar colour = vivid(random) * 255;
            switch (i % 4) {
                case 0:
                    cv::circle(canvas, centre, size, colour, i % 8 ? cv::FILLED : n / 60);
                    break;
                case 1:
                    cv::ellipse(canvas,
                                cv::RotatedRect(centre, cv::Size2f(2.6f * size, 0.8f * size),
                                                random.uniform(0.0f, 180.0f)),
                                colour, cv::FILLED);
                    break;
                case 2: {
                    std::vector<cv::Point> corners;
                    corners.reserve(3);
                    const double turn = random.uniform(0.0, 6.28);
                    for (int k = 0; k < 3; ++k)
                        corners.emplace_back(
                            centre +
                            cv::Point(static_cast<int>(1.3 * size * std::cos(turn + 2.094 * k)),
                                      static_cast<int>(1.3 * size * std::sin(turn + 2.094 * k))));
                    cv::fillConvexPoly(canvas, corners, colour);
                    break;
                }
                default:
                    cv::line(canvas, centre,
                             centre + cv::Point(random.uniform(-n / 3, n / 3),
                                                random.uniform(-n / 3, n / 3)),
                             colour, n / 70);
            }
        }
        cv::rectangle(canvas, {0, 0, n, n}, {40, 40, 46}, n / 40);
    });
    shade(picture, fractal_noise(random, 16, 0.8f), 0.18f);
    return picture;
}

Picture draw_poster_skyline(cv::RNG& random) {
    Picture picture = drawn({0.98, 0.72, 0.45}, [&](cv::Mat& canvas) {
        const int n = canvas.cols;
        for (int y = 0; y < n; ++y) {
            const double t = static_cast<double>(y) / n;
            cv::line(canvas, {0, y}, {n, y}, cv::Scalar(60 + 195 * t, 70 + 110 * t, 150 - 30 * t));
        }
        cv::circle(canvas, {n * 2 / 3, n * 11 / 20}, n / 8, {255, 226, 150}, cv::FILLED);
        for (int layer = 0; layer < 3; ++layer) {
            const cv::Scalar wall(90 - 28 * layer, 60 - 16 * layer, 110 - 26 * layer);
            for (int x = 0; x < n;) {
                const int width = random.uniform(n / 22, n / 9);
                const int top = n * (45 + 10 * layer) / 100 + random.uniform(0, n / 4);
                cv::rectangle(canvas, cv::Point(x, top), cv::Point(x + width, n), wall, cv::FILLED);
                const int pane = n / 75;
                for (int wy = top + pane; wy < n - pane; wy += 2 * pane)
                    for (int wx = x + pane; wx < x + width - pane; wx += 2 * pane)
                        if (random.uniform(0, 3) > 0)
                            cv::rectangle(canvas, {wx, wy, pane, pane * 5 / 4},
                                          random.uniform(0, 4) ? cv::Scalar(250, 214, 120)
                                                               : cv::Scalar(140, 205, 240),
                                          cv::FILLED);
                x += width + random.uniform(0, n / 60);
            }
        }
    });
    shade(picture, fractal_noise(random, 32, 0.9f), 0.12f);
    return picture;
}

Picture draw_poster_logo(cv::RNG& random) {
    Picture picture = drawn({0.09, 0.12, 0.22}, [&](cv::Mat& canvas) {
        const int n = canvas.cols;
        const cv::Point middle(n / 2, n * 21 / 50);
        for (int ray = 0; ray < 24; ++ray) {
            const double a = 6.28319 * ray / 24, b = 6.28319 * (ray + 0.5) / 24;
            const std::vector<cv::Point> fan = {
                middle,
                middle +
                    cv::Point(static_cast<int>(n * std::cos(a)), static_cast<int>(n * std::sin(a))),
                middle + cv::Point(static_cast<int>(n * std::cos(b)),
                                   static_cast<int>(n * std::sin(b)))};
            cv::fillConvexPoly(canvas, fan,
                               ray % 2 ? cv::Scalar(24, 86, 128) : cv::Scalar(30, 120, 140));
        }
        cv::circle(canvas, middle, n * 29 / 100, {245, 240, 228}, cv::FILLED);
        cv::circle(canvas, middle, n * 26 / 100, {214, 58, 66}, cv::FILLED);
        const std::vector<cv::Point> mark = {
            {n * 33 / 100, n * 29 / 100}, {n * 43 / 100, n * 29 / 100},
            {n * 50 / 100, n * 47 / 100}, {n * 57 / 100, n * 29 / 100},
            {n * 67 / 100, n * 29 / 100}, {n * 54 / 100, n * 60 / 100},
            {n * 46 / 100, n * 60 / 100}};
        cv::fillPoly(canvas, std::vector<std::vector<cv::Point>>{mark}, {250, 246, 236});
        const double scale = n / 260.0;
        int baseline = 0;
        const cv::Size text =
            cv::getTextSize("VANTAGE", cv::FONT_HERSHEY_DUPLEX, scale, n / 70, &baseline);
        cv::putText(canvas, "VANTAGE", {(n - text.width) / 2, n * 91 / 100},
                    cv::FONT_HERSHEY_DUPLEX, scale, {250, 210, 90}, n / 70);
        for (int i = 0; i < 60; ++i)
            cv::circle(canvas, {random.uniform(0, n), random.uniform(0, n)},
                       random.uniform(n / 300, n / 120), {250, 240, 200}, cv::FILLED);
    });
    shade(picture, fractal_noise(random, 32, 0.9f), 0.15f);
    return picture;
}

Picture draw_tiles(cv::RNG& random) {
    constexpr int cell = side / 8;
    Picture picture(side, side);
    std::vector<cv::Vec3f> colours;
    for (int i = 0; i < 64; ++i) {
        const cv::Scalar c = 0.55 * vivid(random) + 0.30 * cv::Scalar(0.6, 0.75, 0.85);
        colours.emplace_back(c[0], c[1], c[2]);
    }
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const bool grout = x % cell < 3 || y % cell < 3;
            const int index = (y / cell) * 8 + x / cell;
            picture(y, x) =
                grout ? cv::Vec3f(0.85f, 0.85f, 0.83f) : colours[static_cast<std::size_t>(index)];
        }
    shade(picture, fractal_noise(random, 16, 0.8f), 0.25f);
    return picture;
}

Picture noisy(cv::RNG& random, const cv::Scalar& colour, int cells, float gain, float strength) {
    Picture picture = flat(colour);
    shade(picture, fractal_noise(random, cells, gain), strength);
    return picture;
}

Picture draw_metal(cv::RNG& random) {
    Picture picture = flat({0.72, 0.74, 0.77});
    shade(picture, noise_octave(random, 4, 256), 0.10f);
    shade(picture, fractal_noise(random, 8), 0.15f);
    return picture;
}

Picture draw_speckle(cv::RNG& random) {
    Picture picture = drawn({0.62, 0.60, 0.58}, [&](cv::Mat& canvas) {
        const int n = canvas.cols;
        for (int i = 0; i < 900; ++i) {
            const cv::Point at(random.uniform(0, n), random.uniform(0, n));
            const int radius = n / random.uniform(30, 260);
            const double tone = random.uniform(0.3, 1.2);
            for (int dy = -n; dy <= n; dy += n)
                for (int dx = -n; dx <= n; dx += n)
                    cv::circle(canvas, at + cv::Point(dx, dy), radius,
                               cv::Scalar(190, 180, 170) * tone, cv::FILLED);
        }
    });
    shade(picture, fractal_noise(random, 8, 0.8f), 0.25f);
    return picture;
}

Picture draw(StageTexture texture, cv::RNG& random) {
    switch (texture) {
        case StageTexture::plain:
            return flat(cv::Scalar::all(1));
        case StageTexture::wood:
            return draw_wood(random);
        case StageTexture::carpet:
            return draw_carpet(random);
        case StageTexture::checker:
            return draw_checker(random);
        case StageTexture::brick:
            return draw_brick(random);
        case StageTexture::plaster:
            return noisy(random, cv::Scalar::all(0.85), 4, 0.75f, 0.35f);
        case StageTexture::plaid:
            return draw_plaid(random);
        case StageTexture::stripes:
            return draw_stripes(random);
        case StageTexture::flowers:
            return draw_flowers(random);
        case StageTexture::denim:
            return draw_denim(random);
        case StageTexture::poster_shapes:
            return draw_poster_shapes(random);
        case StageTexture::poster_skyline:
            return draw_poster_skyline(random);
        case StageTexture::poster_logo:
            return draw_poster_logo(random);
        case StageTexture::tiles:
            return draw_tiles(random);
        case StageTexture::metal:
            return draw_metal(random);
        case StageTexture::speckle:
            return draw_speckle(random);
    }
    return flat(cv::Scalar::all(1));
}

}  // namespace

std::vector<ColourImage> draw_stage_textures(std::uint64_t seed) {
    std::vector<ColourImage> layers;
    for (int layer = 0; layer < stage_texture_count; ++layer) {
        cv::RNG random(seed * 0x9E3779B97F4A7C15u + static_cast<std::uint64_t>(layer) + 1);
        const Picture picture = draw(static_cast<StageTexture>(layer), random);
        cv::Mat3b coded;
        picture.convertTo(coded, CV_8UC3, 255);
        ColourImage rgba;
        cv::cvtColor(coded, rgba, cv::COLOR_RGB2RGBA);
        layers.push_back(rgba);
    }
    return layers;
}

}  // namespace vantage
