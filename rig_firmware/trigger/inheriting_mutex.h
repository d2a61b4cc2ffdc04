#pragma once

#include <pthread.h>

#include "common/base/error.h"

namespace vantage {

/// Mutex with priority inheritance, for a real-time thread and ordinary ones. The holder runs at
/// the priority of the highest waiting thread. With an ordinary mutex, a holder that a busy
/// computer does not schedule would delay pulses.
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

    // Names that std::lock_guard requires.
    void lock() { ::pthread_mutex_lock(&mutex_); }
    void unlock() { ::pthread_mutex_unlock(&mutex_); }

  private:
    pthread_mutex_t mutex_{};
};

}  // namespace vantage
