#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// Gives the calling thread SCHED_FIFO at this priority (0 leaves it unchanged) and locks the
/// process's memory, as far as this user may. Returns one report line for each: success, or the
/// refusal with the mend. `what` names the thread's output in these lines.
std::vector<std::string> become_realtime(int priority, std::string_view what = "pulses");

}  // namespace vantage
