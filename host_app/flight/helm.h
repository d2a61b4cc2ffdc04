#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "host_app/flight/flight_input.h"
#include "host_app/flight/move.h"
#include "host_app/flight/orbit_camera.h"

namespace vantage {

/// What wheel and shuttle drive.
enum class WheelMode {
    orbit,  ///< the camera around its pivot
    move,   ///< the camera along the planned move
    past,   ///< not the camera but what it shows, frame by frame
};
const char* name_of(WheelMode mode);

/// The virtual camera between a planned move and the operator's hands. Nothing that a hand does
/// makes the picture jump: the camera follows smoothly, and glides back onto the move. Without any
/// input it holds its pose, or the move goes on if it plays.
class Helm {
  public:
    /// A move plays from the start. `has_past`: whether there is a past for the wheel to go
    /// through.
    Helm(const OrbitView& start, std::optional<Move> move, bool has_past = false);

    /// From now on within these limits and, unless it is nothing, as if it had begun at `start`.
    void settle(const FlightLimits& limits, const std::optional<OrbitView>& start);

    /// From now on it stands there, until somebody flies on.
    void stand_at(const OrbitView& view);

    /// From now on hands fly within this corridor; null: anywhere. A planned move is not held up.
    void keep_within(std::shared_ptr<const Corridor> corridor) {
        corridor_ = corridor;
        camera_.keep_within(std::move(corridor));
    }

    /// `rig_view` gives what rig 1, 2, ... sees, for shots that nobody has stored; empty: no such
    /// rig.
    void take(const FlightInput& input,
              const std::function<std::optional<OrbitView>(int number)>& rig_view);
    /// Lets dt_s seconds pass. Precondition: dt_s >= 0.
    void advance(double dt_s);

    OrbitView view() const;
    /// 0..1 along the move, while the camera is on it.
    std::optional<double> move_progress() const;
    WheelMode wheel_mode() const { return mode_; }

  private:
    void take_wheel(const FlightInput& input);
    void next_mode();
    void join_move();
    void leave_move();
    /// Along the move by so many seconds, either way.
    void travel(double seconds);

    OrbitCamera camera_;
    std::shared_ptr<const Corridor> corridor_;
    OrbitView start_;
    FlightLimits limits_;
    bool has_past_;
    WheelMode mode_ = WheelMode::orbit;
    std::array<std::optional<OrbitView>, 9> shots_;

    std::optional<Move> move_;
    bool on_move_ = false, playing_ = false;
    double move_s_ = 0;     ///< where on the move
    double pending_s_ = 0;  ///< what the wheel asked for and is not travelled yet
    OrbitView joined_from_;
    double joining_ = 0;  ///< share of joined_from_ in the view, 1..0
};

}  // namespace vantage
