#include "common/virtual_stage/filmed_bar.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/base/error.h"
#include "common/colour/colour_correction.h"

namespace vantage {
namespace {

constexpr double board_light = 0.01;
/// R, G and B of red LEDs, relative to the strongest.
constexpr std::array<double, 3> led_colour = {1, 0.25, 0.15};

unsigned char coded(double light) {
    return static_cast<unsigned char>(std::lround(255 * srgb_encode(std::clamp(light, 0.0, 1.0))));
}

}  // namespace

BarPlace BarPlace::across(cv::Size picture, int leds) {
    constexpr double margin = 0.15, level = 0.15, fall = 0.03, radius = 0.25;
    BarPlace place;
    place.first_px = {margin * picture.width, level * picture.height};
    place.last_px = {(1 - margin) * picture.width, (level + fall) * picture.height};
    place.led_radius_px =
        std::max(1.0, radius * cv::norm(place.last_px - place.first_px) / std::max(1, leds - 1));
    return place;
}

FilmedBar::FilmedBar(const SyncBar& bar, const BarPlace& place, std::chrono::nanoseconds exposure)
    : bar_(bar), place_(place), exposure_(exposure) {
    if (exposure.count() <= 0) fail("a bar is filmed with an exposure of more than 0 us");
}

void FilmedBar::draw(ColourImage& picture, TaiTime begin) const {
    const auto phase_ns = static_cast<double>(bar_.phase_at(begin).count());
    const auto length_ns = static_cast<double>(exposure_.count());
    const cv::Point2d step = (place_.last_px - place_.first_px) / (bar_.leds() - 1);
    const double reach_px = 2 * place_.led_radius_px;
    const auto tile_of = [&](int led) {
        const cv::Point2d centre = place_.first_px + step * led;
        const cv::Point low(static_cast<int>(std::floor(centre.x - reach_px)),
                            static_cast<int>(std::floor(centre.y - reach_px)));
        const int side = static_cast<int>(std::ceil(2 * reach_px)) + 1;
        return cv::Rect(low, cv::Size(side, side)) & cv::Rect(cv::Point(), picture.size());
    };
    // The whole board first, since the tiles of neighbouring LEDs overlap.
    const unsigned char dark = coded(board_light);
    for (int led = 0; led < bar_.leds(); ++led)
        picture(tile_of(led)).setTo(cv::Scalar(dark, dark, dark, 255));
    for (int led = 0; led < bar_.leds(); ++led) {
        const cv::Point2d centre = place_.first_px + step * led;
        const double light = place_.led_light * bar_.lit_share(led, phase_ns, length_ns);
        const cv::Rect tile = tile_of(led);
        for (int y = tile.y; y < tile.br().y; ++y)
            for (int x = tile.x; x < tile.br().x; ++x) {
                const double inside_px =
                    place_.led_radius_px + 0.5 - cv::norm(cv::Point2d(x, y) - centre);
                if (inside_px <= 0) continue;
                const double share = std::min(1.0, inside_px);
                for (int channel = 0; channel < 3; ++channel)
                    picture(y, x)[channel] =
                        coded(board_light +
                              share * light * led_colour[static_cast<std::size_t>(channel)]);
            }
    }
}

}  // namespace vantage
