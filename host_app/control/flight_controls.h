#pragma once

#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "host_app/control/hid/jog_deck.h"
#include "host_app/control/hid/jog_mapper.h"
#include "host_app/control/tracked_camera.h"
#include "host_app/flight/corridor_books.h"
#include "host_app/flight/flight_plan.h"
#include "host_app/flight/helm.h"
#include "host_app/flight/pilot.h"
#include "host_app/flight/stage_framing.h"

namespace vantage {

/// What hands did, wherever they are, on its way to the programme's thread. Turns add up; a command
/// that is given again before the programme has taken it waits for the next step.
class HandsBox {
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
struct SessionWishes {
    bool toggle_take = false, save_set = false, learn_set = false;
    std::vector<int> outputs;  ///< pressed, 1 and on, in their order
};

/// All hands on the virtual camera: mouse and keyboard where there is a window, and the jog wheels
/// of the deck. Whatever came until a picture is begun is in that picture.
class FlightControls final : public Pilot {
  public:
    struct Settings {
        FlightPlan plan;
        double pulse_rate_hz = 30;
        bool has_past = false;     ///< there is a past to go through
        bool free_flight = false;  ///< hands may leave the corridor
    };
    /// What rig 1, 2, ... sees, for shots that nobody has stored; empty: no such rig.
    using RigView = std::function<std::optional<OrbitView>(int number)>;
    /// How the stage is framed, once that is known.
    using Framing = std::function<std::optional<StageFraming>()>;
    /// What the rigs cover now; null: not known.
    using CorridorNow = std::function<std::shared_ptr<const Corridor>()>;
    /// Without a deck there are no wheels; else it must outlive this. Without `framing` limits are
    /// those of FlightLimits, without `corridor` there is none.
    FlightControls(Settings settings, JogDeck* deck, RigView rig_view, Framing framing = {},
                   CorridorNow corridor = {});

    HandsBox& hands() { return hands_; }
    /// One that speaks flies, until a hand steers.
    TrackedCamera& tracked() { return tracked_; }
    /// Throws what the deck throws.
    PilotStep step(double time_s) override;

    /// Those of the steps since the last call; from any thread.
    SessionWishes take_wishes();

    /// For the desk, from any thread.
    struct Lines {
        std::optional<double> move_progress;  ///< 0..1 while the camera is on a planned move
        std::string wheel_mode;               ///< orbit, move or past
        bool is_tracked = false;              ///< a tracked camera flies
        std::string wheel;  ///< the wheels, what they drive, and what is wrong with one
        CorridorBooks corridor;
    };
    Lines lines() const;

  private:
    std::string wheel_line() const;
    /// Whoever flies, tracked camera or helm.
    void fly(const FlightInput& hands, double dt_s, PilotStep& step);
    void note_coverage(const Corridor* corridor, const CameraState& camera, double dt_s);

    Settings settings_;
    Helm helm_;
    JogDeck* deck_;
    RigView rig_view_;
    Framing framing_;  ///< empty once it has told
    CorridorNow corridor_now_;
    CorridorBooks corridor_books_;
    JogMapper mapper_;
    HandsBox hands_;
    TrackedCamera tracked_;
    CameraGlide glide_;
    bool may_track_ = true;  ///< no hand has taken over
    bool is_tracked_ = false;
    double last_s_ = 0;
    mutable std::mutex mutex_;
    Lines lines_;
    SessionWishes wishes_;
};

}  // namespace vantage
