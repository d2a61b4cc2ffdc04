#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>

#include "common/gl/context/egl_context.h"

namespace vantage {

/// A group of GL contexts, one per thread, that share textures, buffers, programs and fences. A GPU
/// reset loses all of them. Then renew() creates the next generation of the group, each thread
/// joins it and creates its objects again. Objects of an earlier generation may only be destroyed,
/// with a context of that generation current. Thread-safe.
class ContextGroup {
  public:
    /// Leaves the thread's current context as it was. Throws as EglContext() does.
    ContextGroup();

    struct Member {
        std::shared_ptr<const EglContext> context;  ///< current on no thread
        std::uint64_t generation = 0;
    };
    /// Creates a context of the newest generation.
    Member join();
    std::uint64_t generation() const { return generation_; }
    /// Reports that generation `lost` was lost (ContextLost was thrown). The first report creates
    /// the next generation; later reports of the same one do nothing. Throws as EglContext() does.
    void renew(std::uint64_t lost);
    /// The mutex that the group's threads lock while they call the driver (DriverLock); null if the
    /// driver needs none.
    std::mutex* driver() const { return driver_; }
    /// The number of GPU resets so far.
    int losses() const { return static_cast<int>(generation_ - first_generation); }

  private:
    static constexpr std::uint64_t first_generation = 1;

    std::mutex mutex_;
    std::shared_ptr<const EglContext> first_;
    std::mutex* driver_;
    std::atomic<std::uint64_t> generation_ = first_generation;
};

}  // namespace vantage
