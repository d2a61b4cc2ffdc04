#pragma once

#include <vector>

#include <Eigen/Core>

#include "common/sync/sync_bar.h"

namespace vantage {

/// How much light of some of the bar's LEDs came into the pictures of one sensor: a row a picture,
/// a column an LED, linear in the light, in any unit.
struct LedLight {
    std::vector<int> leds;  ///< of every column: its number on the bar
    Eigen::MatrixXd light;
};

/// When a picture was exposed, by the bar.
struct Exposure {
    double centre_ms = 0;  ///< in the bar's period
    double sigma_ms = 0;   ///< one standard deviation
    bool used = false;     ///< false: its light fits no exposure
    /// An LED changed while it was exposed; else its centre is only known to lie somewhere between
    /// two changes.
    bool is_resolved = false;
};

struct ExposureFit {
    double length_ms = 0;
    std::vector<Exposure> exposures;  ///< of every picture
    double misfit = 1;                ///< RMS of the light unexplained, as a share of an LED's
    int used = 0;
};

/// The exposures that explain the light: LED k of picture i shows dark_k + gain_k * (the share of
/// the exposure in which it is lit), with one length for all pictures and nothing known of it, of
/// dark_k and of gain_k. The LEDs that are lit long against the exposure are on or off and tell
/// where in the period it is, as a Gray code; those that change during it tell by their share where
/// its ends are, to a small part of a step. Least squares; pictures that fit nothing are left out.
/// Precondition: the LEDs are the slowest of the bar, slowest first, at least three, and there are
/// at least three pictures.
ExposureFit fit_exposures(const SyncBar& bar, const LedLight& seen);

}  // namespace vantage
