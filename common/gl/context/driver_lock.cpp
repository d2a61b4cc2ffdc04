#include "common/gl/context/driver_lock.h"

#include <cassert>
#include <cerrno>
#include <chrono>
#include <thread>
#include <utility>

#include <dlfcn.h>
#include <pthread.h>

namespace vantage {
namespace {

/// Like the current context, it belongs to the thread.
thread_local std::mutex* held = nullptr;

}  // namespace

DriverLock::DriverLock(std::mutex* driver) : driver_(driver) {
    assert(!held);
    if (!driver_) return;
    driver_->lock();
    held = driver_;
}

DriverLock::~DriverLock() {
    if (!driver_) return;
    held = nullptr;
    driver_->unlock();
}

DriverLock::Pause::Pause() : driver_(std::exchange(held, nullptr)) {
    if (driver_) driver_->unlock();
}

DriverLock::Pause::~Pause() {
    if (!driver_) return;
    driver_->lock();
    held = driver_;
}

}  // namespace vantage

/// Instead of the C library's, for the whole program. llvmpipe's lp_fence_signalled() looks at a
/// fence without its lock: a scene whose fence was just signalled is taken up anew, and the fence
/// and its mutex are freed, while the thread that signalled it has yet to unlock it, which then
/// writes into freed memory (Mesa 22.3; seen as a corrupted heap beside busy programs). A mutex
/// that another thread holds is waited for before it is destroyed, which nobody else's is.
extern "C" __attribute__((visibility("default"))) int pthread_mutex_destroy(
    pthread_mutex_t* mutex) noexcept {
    using Destroy = int (*)(pthread_mutex_t*);
    static const auto destroy =
        reinterpret_cast<Destroy>(dlsym(RTLD_NEXT, "pthread_mutex_destroy"));
    // Who destroys a mutex that it holds itself is not held up for ever.
    constexpr std::chrono::milliseconds patience{500};
    constexpr std::chrono::microseconds look_period{50};
    int held = pthread_mutex_trylock(mutex);
    if (held == EBUSY) {
        const auto end = std::chrono::steady_clock::now() + patience;
        while (held == EBUSY && std::chrono::steady_clock::now() < end) {
            std::this_thread::sleep_for(look_period);
            held = pthread_mutex_trylock(mutex);
        }
    }
    if (held == 0) pthread_mutex_unlock(mutex);
    return destroy(mutex);
}
