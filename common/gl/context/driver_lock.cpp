#include "common/gl/context/driver_lock.h"

#include <cassert>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <thread>
#include <utility>

#include <dlfcn.h>
#include <pthread.h>

#include "common/base/trace/trace.h"

namespace vantage {
namespace {

/// The driver's mutex if this thread holds it. Thread-local, like the current context.
thread_local std::mutex* held = nullptr;
thread_local bool is_urgent = false;

/// The urgent threads that wait for a lock. A mutex alone is not fair: a thread that releases it
/// for a moment takes it back before one that waits has woken up.
struct UrgentWaits {
    std::mutex mutex;
    std::condition_variable ended;
    int count = 0;  ///< guarded by mutex
};
UrgentWaits& urgent_waits() {
    static UrgentWaits waits;
    return waits;
}

/// Longest time that a usual thread lets urgent ones go first, so that it always gets on.
constexpr std::chrono::milliseconds longest_courtesy{50};

void lock(std::mutex& driver) {
    TraceSpan span("driver lock");
    UrgentWaits& urgent = urgent_waits();
    if (is_urgent) {
        {
            const std::lock_guard guard(urgent.mutex);
            ++urgent.count;
        }
        driver.lock();
        {
            const std::lock_guard guard(urgent.mutex);
            --urgent.count;
        }
        urgent.ended.notify_all();
    } else {
        {
            std::unique_lock guard(urgent.mutex);
            urgent.ended.wait_for(guard, longest_courtesy, [&] { return urgent.count == 0; });
        }
        driver.lock();
    }
    span.end_unless_shorter(std::chrono::microseconds(100));
}

}  // namespace

DriverLock::DriverLock(std::mutex* driver, Urgency urgency) : driver_(driver) {
    assert(!held);
    if (!driver_) return;
    is_urgent = urgency == Urgency::urgent;
    lock(*driver_);
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
    lock(*driver_);
    held = driver_;
}

}  // namespace vantage

/// Replaces the C library's function in the whole program, as a workaround for llvmpipe (Mesa
/// 22.3). lp_fence_signalled() reads a fence without its lock: it reuses a scene whose fence was
/// just signalled and frees the fence and its mutex, while the signalling thread has yet to unlock
/// that mutex and then writes to freed memory, which corrupts the heap. So this function waits
/// until no other thread holds the mutex. Well-behaved callers never have to wait.
extern "C" __attribute__((visibility("default"))) int pthread_mutex_destroy(
    pthread_mutex_t* mutex) noexcept {
    using Destroy = int (*)(pthread_mutex_t*);
    static const auto destroy =
        reinterpret_cast<Destroy>(dlsym(RTLD_NEXT, "pthread_mutex_destroy"));
    // A thread that destroys a mutex which it holds itself is not blocked for ever.
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
