#pragma once

#include <map>
#include <span>
#include <string>

#include "host_app/views/depth_view.h"

namespace vantage {

/// Gain compensation: removes the colour differences that remain between calibrated rigs (a lamp
/// that warms up, an iris that was touched), slowly enough to be invisible. Each rig has a gain for
/// each channel in linear light, estimated where the depths of two rigs say that they see the same
/// surface.
///
/// Gains are measured on the pictures without gains, so that there is no feedback. They approach
/// their target exponentially, no faster than `slew_per_s`. Robust means leave out gloss and
/// motion. The mean gain of the rigs stays 1, so that the stage as a whole does not drift. Without
/// enough samples a rig keeps its gain; a rig that was away continues with its last one.
class GainCompensation {
  public:
    static constexpr double slew_per_s = 0.02;  ///< limit of the change of a gain's logarithm
    static constexpr double time_constant_s = 3;
    static constexpr double max_gain = 1.5;  ///< gains stay within 1 / max_gain and max_gain
    static constexpr int min_samples = 60;   ///< common to a pair of rigs, at one instant
    static constexpr double sample_period_s = 0.4;
    /// A smaller logarithm of a gain changes no 8-bit value by a whole step and is not applied.
    static constexpr double negligible = 0.008;

    /// Samples an instant's views, `dt_s` after those of the last call. Their colour corrections
    /// must be those of the calibration. Views without depth are ignored.
    void see(std::span<const DepthView> views, double dt_s);

    /// Adds the gains of its rig to a view's colour correction, unless they are negligible.
    void apply(DepthView& view) const;

    struct Rig {
        Eigen::Vector3d log_gain = Eigen::Vector3d::Zero();
        int samples = 0;  ///< surface points in common with other rigs at the last sample
        Eigen::Vector3d gain() const { return log_gain.array().exp(); }
    };
    /// All rigs that were ever sampled, by name.
    const std::map<std::string, Rig>& rigs() const { return rigs_; }

  private:
    std::map<std::string, Rig> rigs_;
    double since_sample_s_ = sample_period_s;
    int samplings_ = 0;
};

}  // namespace vantage
