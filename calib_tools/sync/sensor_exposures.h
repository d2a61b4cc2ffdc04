#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "calib_tools/sync/exposure_fit.h"
#include "common/image/image.h"

namespace vantage {

/// Brightest channel of every pixel, in which a coloured LED has the most contrast.
GreyImage brightest_channel(const ColourImage& picture);

/// Exposures of one sensor, measured with the bar.
struct SensorExposures {
    ExposureFit fit;
    std::string transfer;  ///< transfer function of the images: "linear", "sRGB" or "gamma 1.8"
    int leds_seen = 0;     ///< number of LEDs slow enough to blink
    /// The images cover too few phases of the LED that is just slower than the exposure, since the
    /// bar's steps divide the time between them. Gains and shares are then uncertain, which the
    /// sigmas of the exposures include.
    bool misses_phases = false;
};

constexpr int fewest_pictures = 8;

/// Images of the bar from one sensor.
struct BarFilm {
    std::string sensor;                 ///< name in sentences: "A left"
    std::vector<GreyImage> pictures;    ///< see brightest_channel()
    std::vector<std::uint64_t> pulses;  ///< of every image
};

/// Finds the bar in a film and measures when each image was exposed. The bar counts in step with
/// the pulses for most images, which distinguishes it from other blinking lights. Bar and sensor
/// have to be at rest, with a global shutter: rolling shutters are not modelled. Throws Error, with
/// the sensor, for too few images, images of several sizes, no visible bar, clipped LEDs, and
/// exposures that the bar cannot determine.
SensorExposures read_bar(const BarFilm& film, const SyncBar& bar, double rate_hz);

}  // namespace vantage
