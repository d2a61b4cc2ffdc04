#pragma once

#include <cstdint>

#include <linux/dma-buf.h>
#include <sys/ioctl.h>

namespace vantage {

/// The processor's reads of a buffer that a device writes stand between its construction and its
/// end. Does nothing for -1.
class DmaBufAccess {
  public:
    explicit DmaBufAccess(int fd) : fd_(fd) { sync(DMA_BUF_SYNC_START | DMA_BUF_SYNC_READ); }
    ~DmaBufAccess() { sync(DMA_BUF_SYNC_END | DMA_BUF_SYNC_READ); }
    DmaBufAccess(const DmaBufAccess&) = delete;
    DmaBufAccess& operator=(const DmaBufAccess&) = delete;

  private:
    void sync(std::uint64_t flags) const {
        dma_buf_sync request{.flags = flags};
        // Buffers of some drivers need no such thing and say so.
        if (fd_ >= 0) ::ioctl(fd_, DMA_BUF_IOCTL_SYNC, &request);
    }
    int fd_;
};

}  // namespace vantage
