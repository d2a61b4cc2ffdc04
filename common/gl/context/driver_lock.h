#pragma once

#include <mutex>

namespace vantage {

/// Serialises the threads that call the GL driver. When llvmpipe maps a buffer or uploads a
/// texture, it walks through the unfinished drawing of every context of the process, without a lock
/// against the threads that draw there, and crashes occasionally (llvmpipe_flush_resource in Mesa
/// 22.3). Mesa 25 locks what it walks through, so its threads draw at the same time
/// (GlInfo::needs_turns). While a thread waits for the GPU (Fence, SlicedDrawing), it releases the
/// lock. All contexts of a display need it, also those that share nothing. The source has a further
/// workaround for the same driver (pthread_mutex_destroy).
class DriverLock {
  public:
    enum class Urgency {
        usual,
        urgent,  ///< a thread with a deadline: gets the lock before usual threads that want it
    };
    /// Waits for the lock. `driver` must outlive this object; null for drivers that need no lock.
    /// A thread may hold one lock at a time.
    explicit DriverLock(std::mutex* driver, Urgency urgency = Urgency::usual);
    ~DriverLock();
    DriverLock(const DriverLock&) = delete;
    DriverLock& operator=(const DriverLock&) = delete;

    /// Releases the lock of this thread during its life, for waits that need nothing of the driver.
    /// No effect on a thread without the lock.
    class Pause {
      public:
        Pause();
        ~Pause();
        Pause(const Pause&) = delete;
        Pause& operator=(const Pause&) = delete;

      private:
        std::mutex* driver_;
    };

  private:
    std::mutex* driver_;
};

}  // namespace vantage
