#include "common/base/cli/stop_signal.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/time/time.h"

namespace vantage {
namespace {

std::atomic<bool> has_been_interrupted = false;
/// When the first signal was taken, by CLOCK_MONOTONIC.
std::atomic<std::int64_t> first_signal_ns = 0;

/// Handles a signal after the first one. A signal that follows at once is the same request sent
/// twice: timeout(1) signals the program and its process group. A later one ends the program.
void take_further_signal(int signal) {
    const std::int64_t passed_ns = to_ns(MonotonicClock::now()) - first_signal_ns;
    if (passed_ns < std::chrono::nanoseconds(StopSignal::same_request).count()) return;
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

/// Installs or removes the handler of further signals. A signal that the program was started with
/// as ignored stays ignored.
void handle_further_signals(bool are_handled) {
    for (const int signal : {SIGINT, SIGTERM}) {
        struct sigaction action {};
        if (sigaction(signal, nullptr, &action) != 0 || action.sa_handler == SIG_IGN) continue;
        if (!are_handled && action.sa_handler != take_further_signal) continue;
        action.sa_handler = are_handled ? take_further_signal : SIG_DFL;
        action.sa_flags = SA_RESTART;
        sigaction(signal, &action, nullptr);
    }
}

sigset_t stop_signals() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    return signals;
}

void set_blocked(bool blocked) {
    const sigset_t signals = stop_signals();
    pthread_sigmask(blocked ? SIG_BLOCK : SIG_UNBLOCK, &signals, nullptr);
}

}  // namespace

StopSignal::StopSignal() {
    const sigset_t signals = stop_signals();
    fd_ = signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK);
    if (fd_ < 0) fail("this system gives no signal descriptor: {}", std::strerror(errno));
    set_blocked(true);
    handle_further_signals(false);
    has_been_interrupted = false;
}

StopSignal::~StopSignal() {
    ::close(fd_);
    set_blocked(false);
}

bool StopSignal::wait_for(std::chrono::nanoseconds time) {
    if (requested_) return true;
    const auto ns = std::max<std::chrono::nanoseconds::rep>(time.count(), 0);
    const timespec timeout{ns / 1'000'000'000, ns % 1'000'000'000};
    pollfd descriptor{fd_, POLLIN, 0};
    if (ppoll(&descriptor, 1, &timeout, nullptr) <= 0) return false;
    signalfd_siginfo taken;
    if (::read(fd_, &taken, sizeof taken) != static_cast<ssize_t>(sizeof taken)) return false;
    requested_ = true;
    if (taken.ssi_signo == SIGINT) has_been_interrupted = true;
    first_signal_ns = to_ns(MonotonicClock::now());
    // From here on a further signal ends the program at once, in case the orderly end hangs.
    handle_further_signals(true);
    set_blocked(false);
    return true;
}

bool StopSignal::was_interrupted() { return has_been_interrupted; }

}  // namespace vantage
