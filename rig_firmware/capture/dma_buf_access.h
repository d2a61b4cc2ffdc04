#pragma once

#include <cstdint>

#include <linux/dma-buf.h>
#include <sys/ioctl.h>

namespace vantage {

/// Scope in which the processor reads a buffer that a device writes (DMA_BUF_IOCTL_SYNC). Does
/// nothing for the descriptor -1.
class DmaBufAccess {
  public:
    explicit DmaBufAccess(int fd) : fd_(fd) { sync(DMA_BUF_SYNC_START | DMA_BUF_SYNC_READ); }
    ~DmaBufAccess() { sync(DMA_BUF_SYNC_END | DMA_BUF_SYNC_READ); }
    DmaBufAccess(const DmaBufAccess&) = delete;
    DmaBufAccess& operator=(const DmaBufAccess&) = delete;

  private:
    void sync(std::uint64_t flags) const {
        dma_buf_sync request{.flags = flags};
        // Some drivers need no synchronisation and refuse the request.
        if (fd_ >= 0) ::ioctl(fd_, DMA_BUF_IOCTL_SYNC, &request);
    }
    int fd_;
};

}  // namespace vantage
