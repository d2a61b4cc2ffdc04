#pragma once

#include "host_app/control/flight_controls.h"
#include "host_app/control/ports/message_budget.h"
#include "host_app/control/table/control_command.h"

namespace vantage {

/// From a port to the programme's next ticks, no more than hands could press.
class CommandIntake {
  public:
    explicit CommandIntake(OperatorInputBox& operator_input) : operator_input_(operator_input) {}

    /// False: it was one too many.
    bool take(const CommandCall& call, MonotonicTime now) {
        FlightInput input;
        apply(call, input);
        const bool is_turn = call.command->argument == CommandArgument::steps;
        return (is_turn || budget_.take(now)) && operator_input_.put(input, now);
    }

  private:
    /// A hand's commands a second, many times over.
    static constexpr double commands_a_second = 200, commands_at_once = 100;

    OperatorInputBox& operator_input_;
    MessageBudget budget_{commands_a_second, commands_at_once};
};

}  // namespace vantage
