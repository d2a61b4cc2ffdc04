#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// Gives the calling thread SCHED_FIFO at this priority (0: leaves it) and locks the process's
/// memory, as far as this user may. Returns a line for the report for each: what was had, or what
/// was refused with the mend. `what` the thread sends, for these lines.
std::vector<std::string> become_realtime(int priority, std::string_view what = "pulses");

}  // namespace vantage
