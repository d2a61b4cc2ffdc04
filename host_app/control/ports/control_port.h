#pragma once

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/time/time.h"
#include "host_app/control/flight_controls.h"
#include "host_app/control/table/lamp.h"
#include "host_app/output/output_url.h"

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

/// A value that one thread puts and others read. Thread-safe.
template <class Value>
class Board {
  public:
    using State = Value;
    void put(Value value) {
        const std::lock_guard lock(mutex_);
        value_ = std::move(value);
    }
    Value state() const {
        const std::lock_guard lock(mutex_);
        return value_;
    }

  private:
    mutable std::mutex mutex_;
    Value value_;
};

/// Lamps of the session, for the ports.
using LampBoard = Board<ShowLamps>;

/// Tally of this camera, as the vision mixer sends it.
struct TallyState {
    bool programme = false, preview = false;
    bool operator==(const TallyState&) const = default;
};
using Tally = Board<TallyState>;

/// Parts of the session that a port acts on or reports. All of them are thread-safe and outlive the
/// ports.
struct ControlBench {
    OperatorInputBox& operator_input;
    TrackedCamera& tracked;
    Tally& tally;
    const LampBoard& lamps;
    LtcBoard& ltc;
};

/// Counters of a port. Every received message is counted in one of them.
struct PortStats {
    std::uint64_t obeyed = 0;
    std::uint64_t unknown = 0;    ///< well formed, but not a known command
    std::uint64_t malformed = 0;  ///< violates the protocol, or has an invalid argument
    std::uint64_t dropped = 0;    ///< exceeds the rate limit
    std::string last_refusal;     ///< the latest unknown or malformed message, for operators
    std::string told;             ///< the latest message that is not a command, for operators
};

/// Network or device port for remote control: it receives commands, camera data or tally, and
/// reports the state. Create, serve and destroy it on one thread.
class ControlPort {
  public:
    virtual ~ControlPort() = default;
    /// Handles what has arrived, and waits for at most this time. Throws Error if the port has
    /// failed.
    virtual void serve(std::chrono::milliseconds most) = 0;
    const PortStats& stats() const { return stats_; }

  protected:
    /// Replaces control characters in received text, so that a terminal can show it.
    static std::string printable(std::string text) {
        for (char& c : text)
            if (c < ' ' || c > '~') c = '?';
        return text;
    }
    void refuse(std::uint64_t PortStats::*counter, std::string sentence) {
        ++(stats_.*counter);
        stats_.last_refusal = std::move(sentence);
    }
    /// Counts a message that violates the protocol, and keeps it for bug reports.
    void refuse_input(std::string_view protocol, std::span<const std::byte> input,
                      std::string sentence);
    PortStats stats_;
};

/// Registry entry of a kind of port. A backend is one file, kinds/NAME_port.cpp, with
/// `NAME_port_entry()`.
struct PortEntry {
    std::string scheme;
    std::string words;  ///< form of its URL, for help
    /// Opens a port. Throws Error if the URL is not valid or its place is taken.
    std::function<std::unique_ptr<ControlPort>(const OutputUrl& url, const ControlBench& bench)>
        open;
};
std::vector<PortEntry> port_entries();

/// Opens a port by the scheme of its URL. Throws Error, also for an unknown scheme.
std::unique_ptr<ControlPort> open_port(const std::string& url, const ControlBench& bench);

/// Listening address of a port; loopback if the URL has no host. Throws Error for an address beyond
/// this computer without `open=yes`.
NetworkPlace listening_place_of(OutputUrl url);

}  // namespace vantage
