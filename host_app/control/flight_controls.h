#pragma once

#include <array>
#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "common/base/time/time.h"
#include "host_app/control/hid/jog_devices.h"
#include "host_app/control/hid/jog_mapper.h"
#include "host_app/control/hid/wheel_input.h"
#include "host_app/flight/camera_pair.h"
#include "host_app/flight/camera_source.h"
#include "host_app/flight/camera_state.h"
#include "host_app/flight/corridor.h"
#include "host_app/flight/flight_plan.h"
#include "host_app/flight/moves/move.h"
#include "host_app/flight/orbit_view.h"

namespace vantage {

/// The newest pose of a tracked camera (a pan bar, a crane, a real camera), handed from the thread
/// that receives it to the programme's thread. Thread-safe.
class TrackedCamera {
  public:
    void put(const CameraState& camera, MonotonicTime now);
    /// Empty if no pose arrived within `timeout`.
    std::optional<CameraState> newest(MonotonicTime now) const;

    static constexpr std::chrono::milliseconds timeout{500};

  private:
    mutable std::mutex mutex_;
    std::optional<CameraState> camera_;
    MonotonicTime received_{};
};

/// Blends from one camera source to the next, so that the view does not jump when the source
/// changes. Not thread-safe.
class CameraGlide {
  public:
    /// Starts a blend from the camera of the last step.
    void begin();
    /// The blended camera, dt_s after the last step; `flown` is the camera of the new source.
    CameraState step(const CameraState& flown, double dt_s);
    bool is_over() const { return remaining_ <= 0; }

  private:
    std::optional<CameraState> shown_, from_;
    double remaining_ = 0;  ///< 1..0
};

/// Operator input on its way to the programme's thread: axes add up, commands queue in order.
/// Thread-safe.
class OperatorInputBox {
  public:
    /// False if the queue was full and the commands of this input were dropped. Axes never are.
    bool put(const FlightInput& input, MonotonicTime now);
    struct Taken {
        FlightInput input;
        std::optional<MonotonicTime> since;  ///< time of the earliest input in it
    };
    /// Everything since the last call.
    Taken take();

    /// Bound of the queue, above anything that an operator gives in one tick.
    static constexpr std::size_t max_commands = 64;

  private:
    std::mutex mutex_;
    Taken waiting_;
};

/// Requests of the operator that the session executes on its own thread.
struct SessionRequests {
    std::vector<SessionCommand> commands;                 ///< in order
    std::optional<FlightController::Change> change = {};  ///< of shots and move
    FlightRecording flight = {};                          ///< a recorded flight; empty: none
    FlightLimits limits = {};                             ///< of that flight
};

/// All operator control of the virtual camera: mouse and keyboard of the window, jog devices, the
/// control ports and tracked cameras. Input that arrives before a frame is started acts on that
/// frame. step() and fly_to_shot() run on the programme's thread; functions that other threads may
/// call say so.
class FlightControls final : public CameraSource {
  public:
    struct Settings {
        FlightPlan plan;
        double pulse_rate_hz = 30;
        bool has_past = false;                  ///< there is a replay buffer or a take
        bool free_flight = false;               ///< the camera may leave the corridor
        std::optional<double> take_begin = {};  ///< first pulse of the take that is shown
    };
    using RigView = FlightController::RigView;
    /// Framing of the stage; empty until it is known.
    using Framing = std::function<std::optional<StageFraming>()>;
    /// The present corridor; null until it is known.
    using CorridorNow = std::function<std::shared_ptr<const Corridor>()>;
    /// `devices` may be null, otherwise it must outlive this object. Without `framing` the limits
    /// are those of FlightLimits; without `corridor` there is no corridor.
    FlightControls(Settings settings, JogDevices* devices, RigView rig_view, Framing framing = {},
                   CorridorNow corridor = {});

    OperatorInputBox& operator_input() { return operator_input_; }
    /// A tracked camera that delivers poses flies, until the operator steers.
    TrackedCamera& tracked() { return tracked_; }
    /// The maps of the wheels, for the desk.
    WheelInput& wheels() { return wheels_; }
    /// Throws the errors of the jog devices.
    CameraStep step(double time_s, std::optional<double> past_pulse) override;
    CameraStep fly_to_shot(int number) override;

    /// Replaces the move by a recorded flight, at the next step. From any thread.
    void keep_flight(Move move);
    /// A camera whose pivot follows a performer, and the performer's position.
    struct Following {
        std::uint64_t camera;  ///< see CameraPair
        Eigen::Vector3d pivot_m;
    };
    /// Reports the new position of a performer. From any thread.
    void follow(const Following& found);

    /// Goes to a pulse of the past and stops there; the last call before a step counts. From any
    /// thread.
    void seek(double pulse);

    using Shots = std::array<std::optional<Shot>, most_shots>;
    /// The stored shots. From any thread.
    Shots shots() const;
    /// The present move; null if there is none. From any thread.
    std::shared_ptr<const Move> move() const;

    /// Requests of the steps since the last call. From any thread.
    SessionRequests take_requests();

    /// Ends a recording after the last step; the flight is then among the requests.
    void end_recording();

    /// Status for the desk, the lamps and the report.
    struct Lines {
        std::optional<double> move_progress;  ///< 0..1 while the operator's camera is on the move
        std::string wheel_mode;               ///< orbit, move or past
        bool is_tracked = false;              ///< a tracked camera flies
        std::string wheel;                    ///< names of the wheels, what they drive, and faults
        CorridorStats corridor;
        bool is_recording = false;  ///< a flight
        bool holds_horizon = true;
        bool is_following = false;         ///< the operator's camera follows a performer
        std::size_t keyframes = 0;         ///< of the move
        std::vector<Following> following;  ///< on programme and preview
        double fly_to_preview_s = 0;       ///< duration of a flight to the preview
        struct Preview {
            OrbitView view;
            std::optional<Coverage> coverage;     ///< empty: not known
            std::optional<double> fly_progress;   ///< 0..1 of the programme's flight to the preview
            std::optional<double> move_progress;  ///< 0..1 while the programme is on the move
        };
        std::optional<Preview> preview;  ///< empty: there is no camera on preview
    };
    /// From any thread.
    Lines lines() const;

  private:
    /// Input of the wheels; sets `since` to the time of the earliest.
    FlightInput take_wheels(double dt_s, std::optional<MonotonicTime>& since);
    std::string wheel_line() const;
    void obey(const command::TogglePreview&);
    void obey(const command::Cut&);
    void obey(const command::FlyToPreview&);
    void obey(const command::SetFlyDuration& set);
    void obey(const command::ToggleTracking&);
    void obey(const command::ToggleFollow&);
    void obey(const command::ToggleRecording&);
    void obey(const command::ToggleJogMap&);
    bool has_preview_to_show() const;
    /// Splits input by the class that executes it.
    void take_time(const FlightInput& input, CameraStep& step);
    void take_session_commands(const FlightInput& input);
    /// Flies the cameras, by the operator or by the tracked camera.
    void fly(const FlightInput& input, double dt_s, std::optional<double> take_s, CameraStep& step);
    /// Writes both cameras, and the time that a move sets, into the step.
    void show(double dt_s, const std::optional<CameraState>& tracked, CameraStep& step);
    /// Takes over what other threads have handed in.
    void take_from_session();
    /// Appends the step's camera to the flight that is being recorded.
    void record(const CameraStep& step, double time_s, std::optional<double> take_s);
    /// Hands the recorded flight to the session. Precondition: mutex_ is held.
    void pass_flight_on();
    void note_lines(const Corridor* corridor);
    void note_coverage(const Corridor* corridor, const CameraState& camera, double dt_s);

    Settings settings_;
    CameraPair cameras_;
    double fly_to_preview_s_;
    JogDevices* devices_;
    RigView rig_view_;
    Framing framing_;  ///< empty once the framing is known
    CorridorNow corridor_now_;
    CorridorStats corridor_stats_;
    JogMapper mapper_;
    WheelInput wheels_;
    OperatorInputBox operator_input_;
    TrackedCamera tracked_;
    CameraGlide glide_;
    bool may_track_ = true;  ///< false after the operator has taken over
    bool is_tracked_ = false;
    double last_s_ = 0;
    bool is_recording_ = false;
    FlightRecording flight_;
    mutable std::mutex mutex_;
    // Guarded by mutex_.
    Lines lines_;
    SessionRequests requests_;
    std::optional<double> seek_;
    Shots shots_;
    std::shared_ptr<const Move> move_;
    std::optional<Move> kept_flight_;  ///< for the next step
    std::vector<Following> followed_;  ///< for the next step
};

}  // namespace vantage
