#pragma once

#include <algorithm>
#include <chrono>

#include "common/base/time/time.h"
#include "host_app/control/flight_controls.h"
#include "host_app/control/table/control_command.h"

namespace vantage {

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

}  // namespace vantage
