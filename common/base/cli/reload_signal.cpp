#include "common/base/cli/reload_signal.h"

#include <cerrno>
#include <csignal>
#include <cstring>

#include <fcntl.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/files/unique_fd.h"

namespace vantage {
namespace {

bool has_terminal() { return bool(UniqueFd(::open("/dev/tty", O_RDWR | O_NOCTTY | O_CLOEXEC))); }

sigset_t reload_signals() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGHUP);
    return signals;
}

}  // namespace

ReloadSignal::ReloadSignal() {
    if (has_terminal()) return;
    const sigset_t signals = reload_signals();
    fd_ = signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK);
    if (fd_ < 0) fail("this system gives no signal descriptor: {}", std::strerror(errno));
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

ReloadSignal::~ReloadSignal() {
    if (fd_ < 0) return;
    const sigset_t signals = reload_signals();
    ::close(fd_);
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
}

bool ReloadSignal::take() {
    signalfd_siginfo taken;
    bool has_come = false;
    while (fd_ >= 0 && ::read(fd_, &taken, sizeof taken) == static_cast<ssize_t>(sizeof taken))
        has_come = true;
    return has_come;
}

}  // namespace vantage
