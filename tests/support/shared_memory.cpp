#include "tests/support/shared_memory.h"

#include <filesystem>
#include <utility>

#include <fcntl.h>
#include <linux/dma-heap.h>
#include <linux/udmabuf.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include "common/base/files/unique_fd.h"

namespace vantage {
namespace {

std::size_t whole_pages(std::size_t bytes) {
    const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    return (bytes + page - 1) / page * page;
}

class MappedSharedMemory final : public SharedMemory {
  public:
    static std::unique_ptr<SharedMemory> map(UniqueFd fd, std::size_t bytes) {
        if (!fd) return nullptr;
        void* start = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd.get(), 0);
        if (start == MAP_FAILED) return nullptr;
        return std::unique_ptr<SharedMemory>(
            new MappedSharedMemory(std::move(fd), static_cast<std::byte*>(start), bytes));
    }
    ~MappedSharedMemory() override { ::munmap(start_, bytes_); }
    int fd() const override { return fd_.get(); }
    std::span<std::byte> bytes() override { return {start_, bytes_}; }

  private:
    MappedSharedMemory(UniqueFd fd, std::byte* start, std::size_t bytes)
        : fd_(std::move(fd)), start_(start), bytes_(bytes) {}
    UniqueFd fd_;
    std::byte* start_;
    std::size_t bytes_;
};

UniqueFd from_udmabuf(std::size_t bytes) {
    const UniqueFd device(::open("/dev/udmabuf", O_RDWR | O_CLOEXEC));
    const UniqueFd memory(::memfd_create("shared", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    if (!device || !memory || ::ftruncate(memory.get(), static_cast<off_t>(bytes)) != 0 ||
        ::fcntl(memory.get(), F_ADD_SEALS, F_SEAL_SHRINK) != 0)
        return {};
    udmabuf_create request{};
    request.memfd = static_cast<__u32>(memory.get());
    request.flags = UDMABUF_FLAGS_CLOEXEC;
    request.size = bytes;
    return UniqueFd(::ioctl(device.get(), UDMABUF_CREATE, &request));
}

UniqueFd from_heap(std::size_t bytes) {
    const UniqueFd device(::open("/dev/dma_heap/system", O_RDWR | O_CLOEXEC));
    dma_heap_allocation_data request{};
    request.len = bytes;
    request.fd_flags = O_RDWR | O_CLOEXEC;
    if (!device || ::ioctl(device.get(), DMA_HEAP_IOCTL_ALLOC, &request) != 0) return {};
    return UniqueFd(static_cast<int>(request.fd));
}

/// A dumb buffer; its memory stays in its dma-buf when the handle is closed.
UniqueFd from_gpu(std::size_t bytes) {
    constexpr std::uint32_t width_px = 1024, bits_per_pixel = 32;
    const auto height_px = static_cast<std::uint32_t>(bytes * 8 / (width_px * bits_per_pixel) + 1);
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator("/dev/dri", ignored)) {
        if (!entry.path().filename().string().starts_with("card")) continue;
        const UniqueFd device(::open(entry.path().c_str(), O_RDWR | O_CLOEXEC));
        std::uint32_t handle = 0, pitch = 0;
        std::uint64_t size = 0;
        if (!device || ::drmModeCreateDumbBuffer(device.get(), width_px, height_px, bits_per_pixel,
                                                 0, &handle, &pitch, &size) != 0)
            continue;
        int fd = -1;
        ::drmPrimeHandleToFD(device.get(), handle, DRM_CLOEXEC | DRM_RDWR, &fd);
        ::drmModeDestroyDumbBuffer(device.get(), handle);
        if (fd >= 0) return UniqueFd(fd);
    }
    return {};
}

}  // namespace

std::unique_ptr<SharedMemory> SharedMemory::make(std::size_t bytes) {
    const std::size_t pages = whole_pages(bytes);
    for (const auto source : {from_udmabuf, from_heap, from_gpu})
        if (auto memory = MappedSharedMemory::map(source(pages), pages)) return memory;
    return nullptr;
}

}  // namespace vantage
