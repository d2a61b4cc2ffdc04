#include <atomic>
#include <csignal>
#include <cstdlib>

#include <dlfcn.h>
#include <time.h>

// For LD_PRELOAD into a program of Vantage: SIGUSR1 sets its clocks of the time of day forward and
// SIGUSR2 back, as a person or NTP does, by a second or by CLOCK_SET_MS milliseconds. With
// CLOCK_SET_BY_RTMIN these are SIGRTMIN + 1 and + 2, so that another such library can have the
// others.

namespace {

constexpr long ns_per_ms = 1'000'000, ns_per_s = 1'000'000'000;

std::atomic<long> step_ns = ns_per_s, ahead_ns = 0;

void set_ahead(int /*signal*/) { ahead_ns += step_ns; }
void set_back(int /*signal*/) { ahead_ns -= step_ns; }

void add(timespec& time, long ns) {
    time.tv_sec += ns / ns_per_s;
    time.tv_nsec += ns % ns_per_s;
    if (time.tv_nsec >= ns_per_s) {
        time.tv_nsec -= ns_per_s;
        ++time.tv_sec;
    } else if (time.tv_nsec < 0) {
        time.tv_nsec += ns_per_s;
        --time.tv_sec;
    }
}

[[gnu::constructor]] void listen() {
    if (const char* ms = std::getenv("CLOCK_SET_MS")) step_ns = ns_per_ms * std::atol(ms);
    const bool by_rtmin = std::getenv("CLOCK_SET_BY_RTMIN") != nullptr;
    std::signal(by_rtmin ? SIGRTMIN + 1 : SIGUSR1, set_ahead);
    std::signal(by_rtmin ? SIGRTMIN + 2 : SIGUSR2, set_back);
}

template <class Function>
Function* next_of(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

bool is_of_the_day(clockid_t clock) { return clock == CLOCK_REALTIME || clock == CLOCK_TAI; }

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
    static auto* const real = next_of<int(clockid_t, timespec*)>("clock_gettime");
    const int status = real(clock, time);
    if (status == 0 && is_of_the_day(clock)) add(*time, ahead_ns);
    return status;
}

extern "C" int clock_nanosleep(clockid_t clock, int flags, const timespec* time, timespec* rest) {
    static auto* const real =
        next_of<int(clockid_t, int, const timespec*, timespec*)>("clock_nanosleep");
    timespec until = *time;
    if ((flags & TIMER_ABSTIME) != 0 && is_of_the_day(clock)) add(until, -ahead_ns);
    return real(clock, flags, &until, rest);
}
