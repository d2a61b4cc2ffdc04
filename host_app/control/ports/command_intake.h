#pragma once

#include "host_app/control/flight_controls.h"
#include "host_app/control/ports/message_budget.h"
#include "host_app/control/table/control_command.h"

namespace vantage {

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
