#include "common/base/kernel_clock.h"

#include <sys/timex.h>

namespace vantage {

KernelClock read_kernel_clock() {
    // Whoever trims the clock resets its greatest error, which grows by 500 ppm until the next
    // time.
    constexpr long growth_us_per_s = 500, lately_s = 10;
    timex state{};
    if (::adjtimex(&state) < 0) return {};
    return {.tai_offset_s = state.tai,
            .is_synchronized = (state.status & STA_UNSYNC) == 0,
            .was_set_lately = state.maxerror <= lately_s * growth_us_per_s};
}

}  // namespace vantage
