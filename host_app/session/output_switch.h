#pragma once

#include <optional>
#include <string>

#include "common/base/time/time.h"
#include "host_app/output/output_supervisor.h"

namespace vantage {

/// An operator's keys for outputs: one that is off is begun at once, one that runs is ended by the
/// second press within three seconds.
class OutputSwitch {
  public:
    explicit OutputSwitch(OutputSupervisor& desk) : desk_(desk) {}

    /// `number`: from 1 on; of one that there is not question() says so.
    void press(int number, MonotonicTime now);
    /// What the operator is asked or told; empty: nothing.
    std::string question(MonotonicTime now) const;

  private:
    struct Asked {
        int number;
        std::string words;
        MonotonicTime until;
    };
    OutputSupervisor& desk_;
    std::optional<Asked> asked_;
};

}  // namespace vantage
