#pragma once

#include <chrono>
#include <mutex>
#include <utility>

#include "common/base/time/time.h"
#include "host_app/control/flight_controls.h"
#include "host_app/control/ports/ltc_board.h"
#include "host_app/control/table/lamp.h"

namespace vantage {

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
