#include "common/base/time/kernel_clock.h"

#include <sys/timex.h>
#include <time.h>

namespace vantage {

namespace {

int seconds_between_tai_and_utc() {
    timespec utc{}, tai{};
    ::clock_gettime(CLOCK_REALTIME, &utc);
    ::clock_gettime(CLOCK_TAI, &tai);
    // TAI is read a moment later, so that the division does not round down to one second less.
    const auto ns = [](const timespec& t) { return t.tv_sec * 1'000'000'000LL + t.tv_nsec; };
    return static_cast<int>((ns(tai) - ns(utc)) / 1'000'000'000LL);
}

}  // namespace

KernelClock read_kernel_clock() {
    // A daemon that trims the clock resets its maximum error, which then grows by 500 ppm.
    constexpr long growth_us_per_s = 500, lately_s = 10;
    timex state{};
    // A sandbox may forbid adjtimex(); the two clocks themselves show the offset of TAI.
    if (::adjtimex(&state) < 0) return {.tai_offset_s = seconds_between_tai_and_utc()};
    return {.tai_offset_s = state.tai,
            .is_synchronized = (state.status & STA_UNSYNC) == 0,
            .was_set_lately = state.maxerror <= lately_s * growth_us_per_s};
}

}  // namespace vantage
