#pragma once

#include <array>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "host_app/control/hid/jog_devices.h"
#include "host_app/control/hid/jog_mapper.h"
#include "host_app/control/hid/wheel_input.h"
#include "host_app/control/tracked_camera.h"
#include "host_app/flight/camera_pair.h"
#include "host_app/flight/camera_source.h"
#include "host_app/flight/corridor_stats.h"
#include "host_app/flight/flight_plan.h"
#include "host_app/flight/moves/flight_recording.h"
#include "host_app/flight/stage_framing.h"

namespace vantage {

/// What hands did, wherever they are, on its way to the programme's thread. Turns add up; a command
/// that is given again before the programme has taken it waits for the next step.
class OperatorInputBox {
  public:
    /// Commands that wait are bounded: false where these had to be left out. Turns never are.
    bool put(const FlightInput& input, MonotonicTime now);
    struct Taken {
        FlightInput input;
        std::optional<MonotonicTime> since;  ///< of the earliest that is in it
    };
    Taken take();

    static constexpr std::size_t most_waiting = 64;

  private:
    std::mutex mutex_;
    std::deque<Taken> waiting_;
};

/// What hands ask of the session and not of the programme, on its way to the session's thread.
struct SessionRequests {
    bool toggle_take = false, save_background = false, learn_background = false;
    std::string cue_time = {};                 ///< see FlightInput
    std::optional<Eigen::Vector2d> pick = {};  ///< see FlightInput
    std::vector<int> outputs;                  ///< pressed, 1 and on, in their order
    std::optional<FlightController::Change> change = {};   ///< of shots and move, by hand
    FlightRecording flight = {};               ///< that was recorded; empty: none
    FlightLimits limits = {};                  ///< that it was flown in
};

/// All hands on the virtual camera: mouse and keyboard where there is a window, and the jog wheels
/// of the deck. Whatever came until a picture is begun is in that picture.
class FlightControls final : public CameraSource {
  public:
    struct Settings {
        FlightPlan plan;
        double pulse_rate_hz = 30;
        bool has_past = false;     ///< there is a past to go through
        bool free_flight = false;  ///< hands may leave the corridor
        std::optional<double> take_begin =
            {};  ///< the pulse at which the take that is shown begins
    };
    /// What rig 1, 2, ... sees, for shots that nobody has stored; empty: no such rig.
    using RigView = std::function<std::optional<OrbitView>(int number)>;
    /// How the stage is framed, once that is known.
    using Framing = std::function<std::optional<StageFraming>()>;
    /// What the rigs cover now; null: not known.
    using CorridorNow = std::function<std::shared_ptr<const Corridor>()>;
    /// Without a deck there are no wheels; else it must outlive this. Without `framing` limits are
    /// those of FlightLimits, without `corridor` there is none.
    FlightControls(Settings settings, JogDevices* deck, RigView rig_view, Framing framing = {},
                   CorridorNow corridor = {});

    OperatorInputBox& operator_input() { return operator_input_; }
    /// One that speaks flies, until a hand steers.
    TrackedCamera& tracked() { return tracked_; }
    /// The maps of the wheels, to be shown and changed.
    WheelInput& wheels() { return wheels_; }
    /// Throws what the deck throws.
    CameraStep step(double time_s, std::optional<double> past_pulse) override;
    CameraStep fly_to_shot(int number) override;

    /// A flight that was recorded: the move from the next step on. From any thread.
    void keep_flight(Move move);
    /// A camera whose pivot goes with a performer.
    struct Following {
        std::uint64_t camera;  ///< see CameraPair
        Eigen::Vector3d pivot_m;
    };
    /// Where the performer is now. From any thread.
    void follow(const Following& found);

    /// To this pulse of the past, and stand there; from any thread. Of several the last counts.
    void seek(double pulse);

    /// What hands have kept as shots 1, 2, ...; from any thread.
    using Shots = std::array<std::optional<Shot>, most_shots>;
    Shots shots() const;
    /// That is flown or may be, as hands have left it; null: none. From any thread.
    std::shared_ptr<const Move> move() const;

    /// Those of the steps since the last call; from any thread.
    SessionRequests take_requests();

    /// After the last step: what is recorded is among the wishes.
    void end_recording();

    /// For the desk, from any thread.
    struct Lines {
        std::optional<double> move_progress;  ///< 0..1 while the camera in hand is on the move
        std::string wheel_mode;               ///< orbit, move or past
        bool is_tracked = false;              ///< a tracked camera flies
        std::string wheel;  ///< the wheels, what they drive, and what is wrong with one
        CorridorStats corridor;
        bool is_recording = false;  ///< a flight
        bool holds_horizon = true;
        bool is_following = false;  ///< the pivot of the camera in hand goes with a performer
        std::size_t keyframes = 0;  ///< of the move
        std::vector<Following> following;  ///< on programme and preview
        double fly_to_preview_s = 0;       ///< that a flight to the preview's view takes
        /// While there is a camera on preview, which hands fly.
        struct Preview {
            OrbitView view;
            std::optional<Coverage> coverage;     ///< of its picture; nothing: not known
            std::optional<double> fly_progress;   ///< 0..1 while the programme's flies to its view
            std::optional<double> move_progress;  ///< 0..1 while the programme's is on the move
        };
        std::optional<Preview> preview;
    };
    Lines lines() const;

  private:
    /// What the wheels ask for; `since`: when the first of it was moved.
    FlightInput take_wheels(double dt_s, std::optional<MonotonicTime>& since);
    std::string wheel_line() const;
    /// What hands ask of the camera on preview, and of the programme's to come to its view.
    void take_preview(const FlightInput& operator_input);
    /// Whoever flies, tracked camera or helm.
    void fly(const FlightInput& operator_input, double dt_s, std::optional<double> take_s, CameraStep& step);
    /// The programme's camera, and what it says of time, after dt_s; and the one on preview.
    void show(double dt_s, const std::optional<CameraState>& tracked, CameraStep& step);
    /// What the session's thread has made meanwhile.
    void take_from_session();
    /// Keeps the step's camera while a flight is recorded.
    void record(const FlightInput& operator_input, const CameraStep& step, double time_s,
                std::optional<double> take_s);
    /// What was recorded, to the session. Precondition: mutex_ is held.
    void pass_flight_on();
    void note_lines(const Corridor* corridor);
    void note_coverage(const Corridor* corridor, const CameraState& camera, double dt_s);

    Settings settings_;
    CameraPair cameras_;
    double fly_to_preview_s_;
    JogDevices* deck_;
    RigView rig_view_;
    Framing framing_;  ///< empty once it has told
    CorridorNow corridor_now_;
    CorridorStats corridor_stats_;
    JogMapper mapper_;
    WheelInput wheels_;
    OperatorInputBox operator_input_;
    TrackedCamera tracked_;
    CameraGlide glide_;
    bool may_track_ = true;  ///< no hand has taken over
    bool is_tracked_ = false;
    double last_s_ = 0;
    bool is_recording_ = false;
    FlightRecording flight_;
    mutable std::mutex mutex_;
    Lines lines_;
    SessionRequests requests_;
    std::optional<double> seek_;
    Shots shots_;
    std::shared_ptr<const Move> move_;
    std::optional<Move> kept_flight_;  ///< on its way to the helm
    std::vector<Following> followed_;  ///< likewise
};

}  // namespace vantage
