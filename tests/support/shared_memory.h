#pragma once

#include <cstddef>
#include <memory>
#include <span>

namespace vantage {

/// Memory that a test fills and shares with drivers (a dma-buf), like a camera's buffer.
class SharedMemory {
  public:
    /// From the kernel's udmabuf or system heap, or a plain buffer of a GPU; null if this computer
    /// has none of them, or this user may not use them.
    static std::unique_ptr<SharedMemory> make(std::size_t bytes);
    virtual ~SharedMemory() = default;

    virtual int fd() const = 0;
    /// At least the requested size.
    virtual std::span<std::byte> bytes() = 0;
};

}  // namespace vantage
