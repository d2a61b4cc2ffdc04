#pragma once

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "common/base/time/time.h"
#include "host_app/control/flight_controls.h"
#include "host_app/control/table/lamp.h"

namespace vantage {

/// Text for operators: "3 frames ahead of the house's time code".
inline std::string words_of_ltc(std::int64_t frames_ahead) {
    if (frames_ahead == 0) return "in step with the house's time code";
    const std::int64_t frames = std::abs(frames_ahead);
    return std::to_string(frames) + (frames == 1 ? " frame " : " frames ") +
           (frames_ahead > 0 ? "ahead of" : "behind") + " the house's time code";
}

/// State of the received linear time code. Thread-safe.
class LtcBoard {
  public:
    struct State {
        std::string code;               ///< empty: no code at present
        std::int64_t frames_ahead = 0;  ///< relative to the house time of day
    };
    void put(State state) {
        const std::lock_guard lock(mutex_);
        state_ = std::move(state);
        heard_ = MonotonicClock::now();
    }
    /// State of the last half second.
    State state() const {
        const std::lock_guard lock(mutex_);
        constexpr std::chrono::milliseconds patience{500};
        return MonotonicClock::now() - heard_ > patience ? State() : state_;
    }

  private:
    mutable std::mutex mutex_;
    State state_;
    MonotonicTime heard_{};
};

/// Lamps of the session, shared by its thread with those of the ports. Thread-safe.
class LampBoard {
  public:
    void show(ShowLamps lamps) {
        const std::lock_guard lock(mutex_);
        shown_ = std::move(lamps);
    }
    ShowLamps shown() const {
        const std::lock_guard lock(mutex_);
        return shown_;
    }

  private:
    mutable std::mutex mutex_;
    ShowLamps shown_;
};

/// Tally of this camera, as the vision mixer sends it. Thread-safe.
class Tally {
  public:
    struct State {
        bool programme = false, preview = false;
        bool operator==(const State&) const = default;
    };
    void put(State state) {
        const std::lock_guard lock(mutex_);
        state_ = state;
    }
    State state() const {
        const std::lock_guard lock(mutex_);
        return state_;
    }

  private:
    mutable std::mutex mutex_;
    State state_;
};

/// Parts of the session that a port acts on or reports. All of them are thread-safe and outlive the
/// ports.
struct ControlBench {
    OperatorInputBox& operator_input;
    TrackedCamera& tracked;
    Tally& tally;
    const LampBoard& lamps;
    LtcBoard& ltc;
};

}  // namespace vantage
