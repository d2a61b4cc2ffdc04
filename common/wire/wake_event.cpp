#include "common/wire/wake_event.h"

#include <cerrno>
#include <cstdint>
#include <cstring>

#include <sys/eventfd.h>
#include <unistd.h>

#include "common/base/error.h"

namespace vantage {

WakeEvent::WakeEvent() : fd_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    if (fd_ < 0) fail("no event descriptor can be had: {}", std::strerror(errno));
}

WakeEvent::~WakeEvent() { ::close(fd_); }

void WakeEvent::notify() const {
    const std::uint64_t one = 1;
    // A full counter means that the thread has been woken already.
    [[maybe_unused]] const ssize_t written = ::write(fd_, &one, sizeof one);
}

void WakeEvent::clear() const {
    std::uint64_t count = 0;
    [[maybe_unused]] const ssize_t got = ::read(fd_, &count, sizeof count);
}

}  // namespace vantage
