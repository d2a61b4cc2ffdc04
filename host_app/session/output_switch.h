#pragma once

#include <optional>
#include <string>

#include "common/base/time/time.h"
#include "host_app/output/output_supervisor.h"

namespace vantage {

/// The operator's keys for outputs: a press starts an output that is off, and a second press within
/// three seconds stops one that runs. Used on the session's thread.
class OutputSwitch {
  public:
    explicit OutputSwitch(OutputSupervisor& outputs) : outputs_(outputs) {}

    /// Takes a press for an output, from 1 on. If there is no such output, question() says so.
    void press(int number, MonotonicTime now);
    /// The question or the message for the operator; empty: none.
    std::string question(MonotonicTime now) const;

  private:
    struct Asked {
        int number;
        std::string words;
        MonotonicTime until;
    };
    OutputSupervisor& outputs_;
    std::optional<Asked> asked_;
};

}  // namespace vantage
