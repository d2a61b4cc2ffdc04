#pragma once

#include <pthread.h>

#include "common/base/error.h"

namespace vantage {

/// A mutex between a real-time thread and others. Whoever holds it runs at the priority of the
/// highest who waits for it; with a usual one a holder that a busy computer had put aside would
/// keep pulses waiting for as long.
class InheritingMutex {
  public:
    InheritingMutex() {
        pthread_mutexattr_t attributes;
        ::pthread_mutexattr_init(&attributes);
        ::pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT);
        const int refused = ::pthread_mutex_init(&mutex_, &attributes);
        ::pthread_mutexattr_destroy(&attributes);
        if (refused != 0) fail("this kernel has no mutexes that inherit priority");
    }
    ~InheritingMutex() { ::pthread_mutex_destroy(&mutex_); }
    InheritingMutex(const InheritingMutex&) = delete;
    InheritingMutex& operator=(const InheritingMutex&) = delete;

    // As std::lock_guard wants them.
    void lock() { ::pthread_mutex_lock(&mutex_); }
    void unlock() { ::pthread_mutex_unlock(&mutex_); }

  private:
    pthread_mutex_t mutex_{};
};

}  // namespace vantage
