#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>

#include "common/gl/context/egl_context.h"

namespace vantage {

/// Contexts that share textures, buffers, programs and fences, for threads of their own. A GPU that
/// is reset takes all of them along: then the group is made anew as its next generation, and each
/// thread joins it again and makes its objects anew. Those of a generation before are only to be
/// destroyed, on a context of it.
class ContextGroup {
  public:
    /// Nothing is current afterwards that was not before. Throws as EglContext() does.
    ContextGroup();

    struct Member {
        std::shared_ptr<const EglContext> context;  ///< current on no thread
        std::uint64_t generation = 0;
    };
    /// A new context of the newest generation.
    Member join();
    std::uint64_t generation() const { return generation_; }
    /// What was thrown (ContextLost) tells that this generation is lost: the first who says so
    /// makes the next one. Throws as EglContext() does.
    void renew(std::uint64_t lost);
    /// What its threads take turns for (DriverTurn); null where they need not.
    std::mutex* driver() const { return driver_; }
    /// How often that was.
    int losses() const { return static_cast<int>(generation_ - first_generation); }

  private:
    static constexpr std::uint64_t first_generation = 1;

    std::mutex mutex_;
    std::shared_ptr<const EglContext> first_;
    std::mutex* driver_;
    std::atomic<std::uint64_t> generation_ = first_generation;
};

}  // namespace vantage
