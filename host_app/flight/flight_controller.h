#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "host_app/flight/flight_book.h"
#include "host_app/flight/flight_habits.h"
#include "host_app/flight/flight_input.h"
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
class FlightController {
  public:
    /// A move plays from the start. `has_past`: whether there is a past for the wheel to go
    /// through.
    FlightController(const OrbitView& start, std::optional<Move> move, bool has_past = false,
         const FlightHabits& habits = {});

    /// Shots, and a move for when there is none yet, which is flown when hands say so.
    void keep(const FlightBook& book);
    /// A flight that was recorded: the move from now on.
    void keep_flight(Move move);
    /// Shots and move, where hands changed one of them since the last call.
    struct Change {
        FlightBook book;
        bool is_of_move = false;
    };
    std::optional<Change> take_change();

    /// From now on within these limits and, unless it is nothing, as if it had begun at `start`.
    void settle(const FlightLimits& limits, const std::optional<OrbitView>& start);

    /// From now on it stands there, until somebody flies on.
    void stand_at(const CameraState& camera);

    /// Flies from rest to rest to where the other stands, whose horizon it takes over too.
    void fly_over_to(const FlightController& other, double duration_s);
    /// Stays where it is, whatever it was on.
    void halt();
    /// Has shots and, if that was changed, the move of another helm from now on.
    void share(const Change& change);
    void set_wheel_mode(WheelMode mode) { mode_ = mode; }

    /// Carries the pivot, and the camera with it, to a point, unless it is on a move.
    void carry_pivot_to(const Eigen::Vector3d& pivot_m);

    /// From now on hands fly within this corridor; null: anywhere. A planned move is not held up.
    void keep_within(std::shared_ptr<const Corridor> corridor) {
        corridor_ = corridor;
        camera_.keep_within(std::move(corridor));
    }

    /// On a move: stops it there, or plays on.
    void toggle_pause();
    /// Where the camera is on a move it stays there, in hand.
    void leave_move();

    /// `rig_view` gives what rig 1, 2, ... sees, for shots that nobody has stored; empty: no such
    /// rig. `take_s`: of a take, where it is shown, for keyframes.
    void take(const FlightInput& input,
              const std::function<std::optional<OrbitView>(int number)>& rig_view,
              std::optional<double> take_s = {});
    /// Lets dt_s seconds pass. Precondition: dt_s >= 0.
    void advance(double dt_s);

    OrbitView view() const;
    /// 0..1 along the move, while the camera is on it.
    std::optional<double> move_progress() const;
    /// 0..1 while it flies to a shot or over to another helm's view.
    std::optional<double> flight_progress() const;
    /// Where in its take the move is, while the camera is on it; nothing: it says nothing of a
    /// take.
    std::optional<double> move_take_s() const;
    WheelMode wheel_mode() const { return mode_; }
    const FlightLimits& limits() const { return limits_; }
    bool holds_horizon() const { return holds_horizon_; }
    std::size_t keyframes() const { return move_ ? move_->keyframes().size() : 0; }

  private:
    /// On its way to a shot.
    struct ShotFlight {
        OrbitView from, to;
        double duration_s, gone_s = 0;
        Easing easing;
    };
    std::optional<Shot>& shot(int number);
    void fly_to(const OrbitView& view, double duration_s, Easing easing);
    void look_at(const Eigen::Vector3d& pivot_m);
    void edit_move(const FlightInput& input, std::optional<double> take_s);
    void jump_keyframes(int count);
    /// Where on the move, within its duration.
    double place_s() const;
    void set_move(std::optional<Move> move);
    void take_wheel(const FlightInput& input);
    void next_mode();
    void join_move();
    /// Along the move by so many seconds, either way.
    void travel(double seconds);

    OrbitCamera camera_;
    std::shared_ptr<const Corridor> corridor_;
    OrbitView start_;
    FlightLimits limits_;
    bool has_past_, holds_horizon_;
    FlightHabits habits_;
    WheelMode mode_ = WheelMode::orbit;
    std::array<std::optional<Shot>, most_shots> shots_;
    std::optional<ShotFlight> shot_flight_;
    bool is_changed_ = false, is_move_changed_ = false;  ///< since take_change()

    std::optional<Move> move_;
    bool on_move_ = false, playing_ = false;
    double move_s_ = 0;     ///< where on the move
    double pending_s_ = 0;  ///< what the wheel asked for and is not travelled yet
    OrbitView joined_from_;
    double joining_ = 0;  ///< share of joined_from_ in the view, 1..0
};

}  // namespace vantage
