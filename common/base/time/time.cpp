#include "common/base/time/time.h"

#include <cerrno>

#include <time.h>

namespace vantage {
namespace {

std::int64_t read_clock_ns(clockid_t clock) {
    timespec t{};
    clock_gettime(clock, &t);
    return t.tv_sec * nanoseconds_per_second + t.tv_nsec;
}

}  // namespace

TaiTime TaiClock::now() { return tai_from_ns(read_clock_ns(CLOCK_TAI)); }

MonotonicTime MonotonicClock::now() { return monotonic_from_ns(read_clock_ns(CLOCK_MONOTONIC)); }

void sleep_until(TaiTime deadline) {
    // The kernel sleeps on CLOCK_MONOTONIC: on CLOCK_TAI, a clock that is set back by an hour would
    // hold the thread for an hour. A clock that is trimmed runs at most 0.05 % off, so the last
    // thousandth of a long sleep is slept again.
    constexpr std::chrono::nanoseconds short_sleep = std::chrono::milliseconds(1);
    std::chrono::nanoseconds remaining = deadline - TaiClock::now();
    while (remaining.count() > 0) {
        const std::chrono::nanoseconds sleep =
            remaining > short_sleep ? remaining - remaining / 1024 : remaining;
        const std::int64_t ns = to_ns(MonotonicClock::now() + sleep);
        const timespec t{ns / nanoseconds_per_second, ns % nanoseconds_per_second};
        while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
        }
        const std::chrono::nanoseconds left = deadline - TaiClock::now();
        if (left > remaining) return;  // the clock was set back
        remaining = left;
    }
}

}  // namespace vantage
