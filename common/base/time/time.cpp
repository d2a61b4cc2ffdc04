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
    const std::int64_t ns = to_ns(deadline);
    const timespec t{ns / nanoseconds_per_second, ns % nanoseconds_per_second};
    while (clock_nanosleep(CLOCK_TAI, TIMER_ABSTIME, &t, nullptr) == EINTR) {
    }
}

}  // namespace vantage
