#include "rig_firmware/trigger/realtime.h"

#include <cstring>

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

namespace vantage {

std::vector<std::string> become_realtime(int priority, std::string_view what) {
    std::vector<std::string> report;
    if (priority == 0) {
        report.push_back(fmt::format("{} run without real-time priority, as configured", what));
    } else {
        const sched_param request{.sched_priority = priority};
        const int refused = ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &request);
        report.push_back(
            refused == 0
                ? fmt::format("{} run with SCHED_FIFO priority {}", what, priority)
                : fmt::format("{} run without real-time priority ({}): give the program "
                              "CAP_SYS_NICE or raise the limit rtprio, or they will be late",
                              what, std::strerror(refused)));
    }
    // MCL_ONFAULT locks only pages that are used; all mapped memory would exceed the limit.
    const bool is_locked = ::mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0;
    report.push_back(is_locked ? std::string("memory is locked")
                               : fmt::format("memory is not locked ({}): raise the limit memlock, "
                                             "or {} may wait for pages",
                                             std::strerror(errno), what));
    return report;
}

}  // namespace vantage
