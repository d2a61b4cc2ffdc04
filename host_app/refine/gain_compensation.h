#pragma once

#include <map>
#include <span>
#include <string>

#include "host_app/views/depth_view.h"

namespace vantage {

/// Takes out what is left of the colour differences between rigs (a lamp that warms up, an iris
/// that was touched after the calibration), slowly enough that nobody sees it happen: a gain a
/// channel in linear light for every rig, estimated where two rigs' depths say that they see the
/// same surface.
///
/// Gains are found from the pictures before they are applied, so that nothing feeds back; they
/// approach their goal exponentially, and no faster than `slew_per_s`. Robust means leave out gloss
/// and what moves. The rigs' mean gain stays 1, so that the whole stage does not drift; without
/// enough evidence a rig's gain stays as it is, and a rig that was away goes on with its last one.
class GainCompensation {
  public:
    static constexpr double slew_per_s = 0.02;  ///< of the gains' logarithms
    static constexpr double time_constant_s = 3;
    static constexpr double largest = 1.5;    ///< gains are within 1 / largest to largest
    static constexpr int least_samples = 60;  ///< of a pair of rigs, at an instant
    static constexpr double look_period_s = 0.4;
    /// Logarithms of gains up to here change no code of 8 bits by as much as one.
    static constexpr double unseen = 0.008;

    /// Looks at an instant's views, `dt_s` after the one before; their colour corrections are those
    /// of the calibration. Views without depth give no evidence.
    void see(std::span<const DepthView> views, double dt_s);

    /// Adds its rig's gains to a view's colour correction, if they would be seen.
    void apply(DepthView& view) const;

    struct Rig {
        Eigen::Vector3d log_gain = Eigen::Vector3d::Zero();
        int samples = 0;  ///< surface points that it shared with others when it was last seen
        Eigen::Vector3d gain() const { return log_gain.array().exp(); }
    };
    /// Of all rigs that were ever seen.
    const std::map<std::string, Rig>& rigs() const { return rigs_; }

  private:
    std::map<std::string, Rig> rigs_;
    double since_look_s_ = look_period_s;
    int looks_ = 0;
};

}  // namespace vantage
