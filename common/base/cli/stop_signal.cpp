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

namespace vantage {
namespace {

std::atomic<bool> has_been_interrupted = false;

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
    // From here on the signals have their default effect, in case the orderly end hangs.
    set_blocked(false);
    return true;
}

bool StopSignal::was_interrupted() { return has_been_interrupted; }

}  // namespace vantage
