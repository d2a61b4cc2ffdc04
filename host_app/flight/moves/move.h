#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "host_app/flight/orbit_view.h"

namespace vantage {

/// How the camera leaves a keyframe.
enum class Easing {
    smooth,  ///< through the keyframes without a stop (cubic Hermite, Catmull-Rom tangents)
    linear,  ///< at constant speed
    ease,    ///< from rest to rest
    cut,     ///< stays, and jumps at the next keyframe
};

/// 0..1 from rest to rest, at 0..1 of the time.
inline double eased(double s) { return s * s * (3 - 2 * s); }

/// What runs from keyframe to keyframe.
enum class MovePath {
    orbit,  ///< pivot, azimuth, elevation, roll, the logarithm of the distance
    free,   ///< the camera's place, and its turn as a quaternion
};

struct MoveKeyframe {
    double time_s = 0;
    OrbitView view;
    Easing easing = Easing::smooth;
    std::optional<double> take_s = {};  ///< where in a take, in seconds from its beginning
};

/// A flight that was planned: keyframes on a time line. Between them the path's numbers and the
/// field of view run on cubic Hermite curves (E. Catmull and R. Rom, "A class of local
/// interpolating splines", 1974; tangents for uneven times), and quaternions on the like curves of
/// K. Shoemake
/// ("Animating rotation with quaternion curves", 1985). The camera starts and ends at rest, unless
/// the move loops. Time in a take runs straight from keyframe to keyframe.
class Move {
  public:
    /// Preconditions: a keyframe or more, the first at 0 s, times growing; take_s in all or none;
    /// of a looping move, which has two, the last view is the first one, whole turns aside.
    Move(std::vector<MoveKeyframe> keyframes, bool loop, const FlightLimits& limits = {},
         MovePath path = MovePath::orbit);

    /// The move of a flight file (see load_flight()). Throws Error likewise, and where it has none.
    static Move load(const std::filesystem::path& path);

    /// The view at a time; before the start the first, after the end the last one, or around again
    /// if the move loops. On an orbit within the flight limits, on a free path above the floor.
    OrbitView at(double time_s) const;
    /// Nothing: it says nothing of a take.
    std::optional<double> take_s_at(double time_s) const;

    double duration_s() const { return keyframes_.back().time_s; }
    bool loops() const { return loop_; }
    MovePath path() const { return path_; }
    const FlightLimits& limits() const { return limits_; }
    const std::vector<MoveKeyframe>& keyframes() const { return keyframes_; }

  private:
    static constexpr int channels = 8, rotation = 3;  ///< where three of them are, on a free path
    using Channels = Eigen::Matrix<double, channels, 1>;
    struct Place {
        std::size_t segment;
        double share;  ///< 0..1 of it
    };

    Place place_of(double time_s) const;
    double duration_of(std::size_t segment) const;
    Channels slope(std::size_t segment) const;
    Channels tangent(std::size_t keyframe) const;
    Eigen::Quaterniond turn_at(const Place& place) const;

    std::vector<MoveKeyframe> keyframes_;
    std::vector<Channels> values_, tangents_;
    std::vector<Eigen::Quaterniond> turns_;  ///< of a free path, each in its neighbour's hemisphere
    bool loop_;
    FlightLimits limits_;
    MovePath path_;
};

}  // namespace vantage
