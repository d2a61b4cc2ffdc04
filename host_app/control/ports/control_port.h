#pragma once

#include <algorithm>
#include <atomic>
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
#include <thread>
#include <utility>
#include <vector>

#include "common/base/time/time.h"
#include "host_app/control/flight_controls.h"
#include "host_app/control/table/control_command.h"
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

/// Rate limit of messages (token bucket): a number per second, and a number at once after a rest.
/// Not thread-safe.
class MessageBudget {
  public:
    MessageBudget(double per_second, double at_once)
        : per_second_(per_second), at_once_(at_once), left_(at_once) {}

    /// Returns true if one more message is allowed now.
    bool take(MonotonicTime now) {
        if (last_ != MonotonicTime{})
            left_ = std::min(
                at_once_, left_ + per_second_ * std::chrono::duration<double>(now - last_).count());
        last_ = now;
        if (left_ < 1) return false;
        left_ -= 1;
        return true;
    }

  private:
    double per_second_, at_once_, left_;
    MonotonicTime last_{};
};

/// Passes commands from a port to the programme's next ticks, and limits their rate. Use it from
/// one thread.
class CommandIntake {
  public:
    explicit CommandIntake(OperatorInputBox& operator_input) : operator_input_(operator_input) {}

    /// Returns false if the command exceeds the limit and is dropped.
    bool take(const CommandCall& call, MonotonicTime now) {
        FlightInput input;
        apply(call, input);
        const bool is_turn = call.command->argument == CommandArgument::steps;
        return (is_turn || budget_.take(now)) && operator_input_.put(input, now);
    }

  private:
    /// Limit of commands per second, and of commands at once after a rest. It is many times what an
    /// operator can press.
    static constexpr double commands_a_second = 200, commands_at_once = 100;

    OperatorInputBox& operator_input_;
    MessageBudget budget_{commands_a_second, commands_at_once};
};

/// State and counters of one port.
struct PortState {
    std::string name;
    PortStats stats;
    std::string failure;  ///< empty while the port works
};

/// All control ports of a session, each on a thread of its own. A port that fails does not affect
/// the others.
class ControlPorts {
  public:
    /// Opens all ports. Throws Error for an invalid URL or a place that is taken.
    ControlPorts(const std::vector<std::string>& urls, const ControlBench& bench);
    ~ControlPorts();
    ControlPorts(const ControlPorts&) = delete;
    ControlPorts& operator=(const ControlPorts&) = delete;

    /// Closes all ports; their counters stay readable.
    void close();
    std::vector<PortState> states() const;

  private:
    struct Port {
        std::unique_ptr<ControlPort> port;
        PortState state;
        std::thread thread;
    };
    void run(Port& port);

    mutable std::mutex mutex_;  ///< guards the states
    std::atomic<bool> is_ending_ = false;
    std::vector<std::unique_ptr<Port>> ports_;
};

}  // namespace vantage
