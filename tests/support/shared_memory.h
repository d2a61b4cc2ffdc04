#pragma once

#include <cstddef>
#include <memory>
#include <span>

namespace vantage {

/// Memory that a test fills and that drivers share (a dma-buf), as a camera's buffer is.
class SharedMemory {
  public:
    /// From the kernel's udmabuf or its system heap, or else a plain buffer of a GPU; null where
    /// this computer has, or gives this user, none of them.
    static std::unique_ptr<SharedMemory> make(std::size_t bytes);
    virtual ~SharedMemory() = default;

    virtual int fd() const = 0;
    /// At least as many as asked for.
    virtual std::span<std::byte> bytes() = 0;
};

}  // namespace vantage
