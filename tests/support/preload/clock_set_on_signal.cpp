#include <atomic>
#include <csignal>

#include <dlfcn.h>
#include <time.h>

// To be preloaded (LD_PRELOAD) into a program of Vantage: its clocks of the time of day are set a
// second ahead by SIGUSR1 and a second back by SIGUSR2, as a person or NTP does.

namespace {

std::atomic<int> ahead_s = 0;

void set_ahead(int /*signal*/) { ++ahead_s; }
void set_back(int /*signal*/) { --ahead_s; }

[[gnu::constructor]] void listen() {
    std::signal(SIGUSR1, set_ahead);
    std::signal(SIGUSR2, set_back);
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
    if (status == 0 && is_of_the_day(clock)) time->tv_sec += ahead_s;
    return status;
}

extern "C" int clock_nanosleep(clockid_t clock, int flags, const timespec* time, timespec* rest) {
    static auto* const real =
        next_of<int(clockid_t, int, const timespec*, timespec*)>("clock_nanosleep");
    timespec until = *time;
    if ((flags & TIMER_ABSTIME) != 0 && is_of_the_day(clock)) until.tv_sec -= ahead_s;
    return real(clock, flags, &until, rest);
}
