#pragma once

#include <filesystem>
#include <vector>

#include "host_app/flight/orbit_view.h"

namespace vantage {

/// How the camera leaves a keyframe.
enum class Easing {
    smooth,  ///< through the keyframes without a stop (cubic Hermite, Catmull-Rom tangents)
    linear,  ///< at constant speed
    ease,    ///< from rest to rest
    cut,     ///< stays, and jumps at the next keyframe
};

struct MoveKeyframe {
    double time_s = 0;
    OrbitView view;
    Easing easing = Easing::smooth;
};

/// A flight that was planned: keyframes on a time line. Between them pivot, azimuth, elevation,
/// the logarithm of the distance and the field of view run on cubic Hermite curves (E. Catmull and
/// R. Rom, "A class of local interpolating splines", 1974; tangents for uneven times). The camera
/// starts and ends at rest, unless the move loops.
class Move {
  public:
    /// Preconditions: at least two keyframes, the first at 0 s, times growing; of a looping move
    /// the last view is the first one, whole turns aside.
    Move(std::vector<MoveKeyframe> keyframes, bool loop, const FlightLimits& limits = {});

    /// Reads a move file (hw_config/moves/demo.toml shows every key). Throws Error with file and
    /// line for whatever does not fit.
    static Move load(const std::filesystem::path& path);

    /// The view at a time; before the start the first, after the end the last one, or around again
    /// if the move loops. Always within the flight limits.
    OrbitView at(double time_s) const;
    double duration_s() const { return keyframes_.back().time_s; }
    bool loops() const { return loop_; }

  private:
    static constexpr int channels = 7;
    using Channels = Eigen::Matrix<double, channels, 1>;

    Channels slope(std::size_t segment) const;
    Channels tangent(std::size_t keyframe) const;

    std::vector<MoveKeyframe> keyframes_;
    std::vector<Channels> values_, tangents_;
    bool loop_;
    FlightLimits limits_;
};

}  // namespace vantage
