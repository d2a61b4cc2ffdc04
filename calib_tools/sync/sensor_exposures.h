#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "calib_tools/sync/exposure_fit.h"
#include "common/image/image.h"

namespace vantage {

/// The brightest channel of every pixel: a coloured LED stands out in it most.
GreyImage brightest_channel(const ColourImage& picture);

/// The bar as one sensor saw it.
struct SensorExposures {
    ExposureFit fit;
    std::string transfer;  ///< how the pictures code light: "linear", "sRGB" or "gamma 1.8"
    int leds_seen = 0;     ///< those that are slow enough to blink
    /// The pictures came at too few phases of the LED that is just slower than the exposure, since
    /// the bar's steps divide the time between them: then neither gains nor shares are sure, and
    /// the exposures say so by their sigma.
    bool misses_phases = false;
};

constexpr int fewest_pictures = 8;

/// What one sensor saw of the bar.
struct BarFilm {
    std::string sensor;                 ///< in sentences: "A left"
    std::vector<GreyImage> pictures;    ///< brightest_channel
    std::vector<std::uint64_t> pulses;  ///< of every picture
};

/// Finds the bar in a film and when each picture was exposed. That the bar counts on as the pulses
/// do, for most pictures, tells it from what merely blinks. The bar and the sensor have to stand
/// still, the whole picture to be exposed at once: a rolling shutter is not reckoned with. Throws
/// Error, naming the sensor, for too few pictures, pictures of several sizes, no bar in view, LEDs
/// that are clipped, and exposures that the bar cannot tell.
SensorExposures read_bar(const BarFilm& film, const SyncBar& bar, double rate_hz);

}  // namespace vantage
