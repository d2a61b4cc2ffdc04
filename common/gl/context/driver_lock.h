#pragma once

#include <mutex>

namespace vantage {

/// While it lives, no other thread that takes turns calls the driver. Mesa's llvmpipe looks, when a
/// buffer is mapped or a texture is uploaded, through the unfinished drawing of every context of
/// its process, without a lock against the threads that draw there, and dies of it now and then (to
/// be read in Mesa 22.3, llvmpipe_flush_resource; 25.0 has a lock). Threads take turns at giving it
/// work; while one waits (Fence, SlicedDrawing) it is another's turn. Contexts of one display take
/// turns, also those that share nothing. For the same driver's sake a mutex of this program is
/// destroyed only once nobody holds it (pthread_mutex_destroy, in the source).
class DriverLock {
  public:
    /// Waits until nobody else has the turn. `driver` must outlive it; null: the driver keeps its
    /// contexts apart itself, and there are no turns. A thread has one turn at a time.
    explicit DriverLock(std::mutex* driver);
    ~DriverLock();
    DriverLock(const DriverLock&) = delete;
    DriverLock& operator=(const DriverLock&) = delete;

    /// While it lives, it is another's turn, and this thread calls nothing of the driver but waits.
    /// Without effect on a thread that has no turn.
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
