#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "host_app/flight/corridor.h"
#include "host_app/flight/orbit_view.h"

namespace vantage {

/// Interpolation from a keyframe to the next one.
enum class Easing {
    smooth,  ///< without a stop at the keyframes (cubic Hermite, Catmull-Rom tangents)
    linear,  ///< at constant speed
    ease,    ///< from rest to rest
    cut,     ///< holds the view, and cuts at the next keyframe
};

/// Progress 0..1 of a motion from rest to rest at the share `s` of its time.
inline double eased(double s) { return s * s * (3 - 2 * s); }

/// Quantities that are interpolated between keyframes.
enum class MovePath {
    orbit,  ///< pivot, azimuth, elevation, roll, the logarithm of the distance
    free,   ///< the camera's position, and its rotation as a quaternion
};

struct MoveKeyframe {
    double time_s = 0;
    OrbitView view;
    Easing easing = Easing::smooth;
    std::optional<double> take_s = {};  ///< position in a take, from its start
};

/// A planned camera move: keyframes on a time line, immutable. Between keyframes the quantities of
/// the path and the field of view follow cubic Hermite curves (E. Catmull and R. Rom, "A class of
/// local interpolating splines", 1974, with tangents for uneven times). Quaternions follow the
/// corresponding curves of K. Shoemake ("Animating rotation with quaternion curves", 1985). The
/// camera starts and ends at rest, unless the move loops. The position in a take is interpolated
/// linearly.
class Move {
  public:
    /// Preconditions: at least one keyframe, the first at 0 s, times increase; take_s in all
    /// keyframes or in none. A looping move has at least two keyframes, and its last view is the
    /// same as the first, except for whole turns.
    Move(std::vector<MoveKeyframe> keyframes, bool loop, const FlightLimits& limits = {},
         MovePath path = MovePath::orbit);

    /// Reads the move of a flight file. Throws Error as load_flight() does, and if it has no move.
    static Move load(const std::filesystem::path& path);

    /// The view at a time. Times outside the move give the first or the last view; a looping move
    /// starts again. An orbit stays within the flight limits, a free path above the floor.
    OrbitView at(double time_s) const;
    /// Position in a take; empty if the keyframes have none.
    std::optional<double> take_s_at(double time_s) const;

    double duration_s() const { return keyframes_.back().time_s; }
    bool loops() const { return loop_; }
    MovePath path() const { return path_; }
    const FlightLimits& limits() const { return limits_; }
    const std::vector<MoveKeyframe>& keyframes() const { return keyframes_; }

  private:
    /// On a free path three channels from `rotation` on hold the rotation.
    static constexpr int channels = 8, rotation = 3;
    using Channels = Eigen::Matrix<double, channels, 1>;
    struct Place {
        std::size_t segment;
        double share;  ///< 0..1 within the segment
    };

    Place place_of(double time_s) const;
    double duration_of(std::size_t segment) const;
    Channels slope(std::size_t segment) const;
    Channels tangent(std::size_t keyframe) const;
    Eigen::Quaterniond turn_at(const Place& place) const;

    std::vector<MoveKeyframe> keyframes_;
    std::vector<Channels> values_, tangents_;
    std::vector<Eigen::Quaterniond>
        turns_;  ///< free path only; each in the hemisphere of the one before
    bool loop_;
    FlightLimits limits_;
    MovePath path_;
};

// Edits of a move. Each returns the edited move. A move keeps looping as long as both ends show the
// same view.

/// Appends a keyframe. Its time is the last one's plus the time that passed in the take since then,
/// or plus `after_s` without a take. Without a move the result has this keyframe only.
Move appended(const std::optional<Move>& move, const OrbitView& view, std::optional<double> take_s,
              double after_s, const FlightLimits& limits);

/// Replaces the view of the keyframe at a time, or adds a keyframe there.
Move with_view_at(const Move& move, double time_s, OrbitView view, std::optional<double> take_s);

std::size_t nearest_keyframe(const Move& move, double time_s);
/// Removes a keyframe; empty if it was the only one.
std::optional<Move> without_keyframe(const Move& move, std::size_t keyframe);
/// Shifts a keyframe and all later ones in time, but never to before the preceding keyframe. The
/// first keyframe stays at 0.
Move retimed(const Move& move, std::size_t keyframe, double later_s);

/// A part of a move outside the corridor.
struct UncoveredPart {
    double from_s = 0, to_s = 0;
    Coverage least;
};

/// All parts of a move outside the corridor, in order of time, with times to 0.1 s.
std::vector<UncoveredPart> uncovered_parts(const Move& move, const Corridor& corridor);

/// The camera at one time of a recorded flight.
struct FlightSample {
    double time_s = 0;
    OrbitView view;
    std::optional<double> take_s = {};  ///< playback position in a take, from its start
};
using FlightRecording = std::deque<FlightSample>;

/// Allowed deviation of a move from the recorded flight.
struct FlightTolerance {
    double shift_m = 0.01;     ///< of the camera's place
    double turn_rad = 0.0017;  ///< of its direction and field of view: 0.1 degrees
    double take_s = 0.02;      ///< of the position in the take
};

struct SimplifiedFlight {
    Move move;
    double worst = 0;  ///< largest deviation, in units of the tolerance; may exceed 1
};

/// Simplifies a recorded flight to a move of few keyframes that stays within the tolerance at every
/// sample. If that would need more than most_keyframes, the tolerance is doubled until they
/// suffice. Times start at the first sample. Preconditions: at least one sample, times increase.
SimplifiedFlight simplified(const FlightRecording& flight, const FlightTolerance& tolerance,
                            const FlightLimits& limits, MovePath path);

}  // namespace vantage
