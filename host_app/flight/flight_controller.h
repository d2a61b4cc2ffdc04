#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "host_app/flight/flight_input.h"
#include "host_app/flight/flight_plan.h"
#include "host_app/flight/orbit_camera.h"

namespace vantage {

/// Target of the jog wheel and the shuttle.
enum class WheelMode {
    orbit,  ///< the camera, around its pivot
    move,   ///< the camera, along the planned move
    past,   ///< the playback position, frame by frame
};
const char* name_of(WheelMode mode);

/// Flies the virtual camera by operator input, to stored shots and along a planned move. The view
/// never jumps, except to a shot without a flight time: the camera follows input smoothly and
/// glides back onto the move. Without input it holds its pose, or the move plays on. Not
/// thread-safe.
class FlightController {
  public:
    /// View of rig 1, 2, ..., for shots that were not stored; empty if there is no such rig.
    using RigView = std::function<std::optional<OrbitView>(int number)>;

    /// A move plays from the start. With `has_past` the wheel also has the mode `past`.
    FlightController(const OrbitView& start, std::optional<Move> move, bool has_past = false,
                     const FlightHabits& habits = {});

    /// Takes the shots of a book, and its move if there is none yet. The move does not play.
    void keep(const FlightBook& book);
    /// Replaces the move by a recorded flight.
    void keep_flight(Move move);
    struct Change {
        FlightBook book;
        bool is_of_move = false;
    };
    /// Shots and move, if input changed one of them since the last call.
    std::optional<Change> take_change();

    /// Sets the limits and, unless it is empty, moves the camera to `start`.
    void settle(const FlightLimits& limits, const std::optional<OrbitView>& start);

    /// Puts the camera at a view, where it stays until input flies it on.
    void stand_at(const CameraState& camera);

    /// Flies from rest to rest to the view of another controller, and takes over its horizon.
    void fly_over_to(const FlightController& other, double duration_s);
    /// Stops the camera where it is, whether on a move or on a flight.
    void halt();
    /// Takes shots and, if it was changed, the move of another controller.
    void share(const Change& change);
    void set_wheel_mode(WheelMode mode) { mode_ = mode; }

    /// Shifts the pivot to a point and the camera with it, unless the camera is on a move or
    /// flight.
    void carry_pivot_to(const Eigen::Vector3d& pivot_m);

    /// Limits flight by hand to a corridor; null: no limit. Planned moves are not limited.
    void keep_within(std::shared_ptr<const Corridor> corridor) {
        corridor_ = corridor;
        camera_.keep_within(std::move(corridor));
    }

    /// Pauses the move, or plays it on.
    void toggle_pause();
    /// Ends the move; the camera stays where it is.
    void leave_move();

    /// Executes the axes of the input, then its commands of the group FlightCommand in order.
    /// `take_s` is the playback position in a take, which new keyframes store.
    void take(const FlightInput& input, const RigView& rig_view, std::optional<double> take_s = {});
    /// Precondition: dt_s >= 0.
    void advance(double dt_s);

    OrbitView view() const;
    /// 0..1 while the camera is on the move.
    std::optional<double> move_progress() const;
    /// 0..1 while the camera flies to a shot or to another controller's view.
    std::optional<double> flight_progress() const;
    /// Playback position in the take that the move sets, while the camera is on the move; empty:
    /// the move has no times of a take.
    std::optional<double> move_take_s() const;
    WheelMode wheel_mode() const { return mode_; }
    const FlightLimits& limits() const { return limits_; }
    bool holds_horizon() const { return holds_horizon_; }
    std::size_t keyframes() const { return move_ ? move_->keyframes().size() : 0; }

  private:
    struct ShotFlight {
        OrbitView from, to;
        double duration_s, gone_s = 0;
        Easing easing;
    };
    struct Surroundings {
        const RigView& rig_view;
        std::optional<double> take_s;
    };
    void obey(const command::ResetView&, const Surroundings&);
    void obey(const command::RecallShot& recall, const Surroundings& surroundings);
    void obey(const command::StoreShot& store, const Surroundings&);
    void obey(const command::LookAt& look, const Surroundings&);
    void obey(const command::ToggleHorizon&, const Surroundings&);
    void obey(const command::NextWheelMode&, const Surroundings&);
    void obey(const command::ToggleMove&, const Surroundings&);
    void obey(const command::AddKeyframe&, const Surroundings& surroundings);
    void obey(const command::SetKeyframe&, const Surroundings& surroundings);
    void obey(const command::RemoveKeyframe&, const Surroundings&);
    void obey(const command::JumpKeyframes& jump, const Surroundings&);
    void take_axes(const FlightInput& input);
    void take_wheel(const FlightInput& input);
    void retime(double later_s);

    std::optional<Shot>& shot(int number);
    /// Ends whatever flies the camera, so that the operator does.
    void take_in_hand();
    void fly_to(const OrbitView& view, double duration_s, Easing easing);
    /// Whether the move may have another keyframe; logs a warning if not.
    bool has_room_for_keyframe() const;
    /// Position on the move, from 0 to its duration.
    double place_s() const;
    void set_move(std::optional<Move> move);
    void join_move();
    /// Goes along the move by so many seconds, either way.
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
    double move_s_ = 0;     ///< position on the move
    double pending_s_ = 0;  ///< way along the move that was asked for and is not travelled yet
    OrbitView joined_from_;
    double joining_ = 0;  ///< share of joined_from_ in the view, 1..0
};

}  // namespace vantage
