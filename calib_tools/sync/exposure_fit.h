#pragma once

#include <vector>

#include <Eigen/Core>

#include "common/sync/sync_bar.h"

namespace vantage {

/// Light of some of the bar's LEDs in the images of one sensor: one row per image, one column per
/// LED, linear in the light, in any unit.
struct LedLight {
    std::vector<int> leds;  ///< LED number on the bar of every column
    Eigen::MatrixXd light;
};

/// Exposure time of an image, in the bar's time.
struct Exposure {
    double centre_ms = 0;  ///< within the bar's period
    double sigma_ms = 0;   ///< one standard deviation
    bool used = false;     ///< false: no exposure explains its light
    /// An LED changed during the exposure. Otherwise the centre is only known to be between two
    /// changes.
    bool is_resolved = false;
};

struct ExposureFit {
    double length_ms = 0;
    std::vector<Exposure> exposures;  ///< of every image
    double misfit = 1;                ///< RMS of the unexplained light as a share of an LED's light
    int used = 0;
};

/// Estimates the exposures from the light. LED k of image i shows dark_k + gain_k * (the share of
/// the exposure in which it is lit), with one unknown length for all images and unknown dark_k and
/// gain_k. LEDs that are lit for longer than the exposure are on or off and give its phase in the
/// period as a Gray code. LEDs that change during it give its ends, to a small part of a step.
/// Least squares; images that do not fit are excluded. Precondition: the LEDs are the slowest of
/// the bar, slowest first; at least three LEDs and three images.
ExposureFit fit_exposures(const SyncBar& bar, const LedLight& seen);

}  // namespace vantage
