#pragma once

#include <cstdint>
#include <filesystem>
#include <future>

#include "common/av/av_handles.h"
#include "common/base/files/unique_fd.h"

namespace vantage {

/// A new file that libavformat writes through. Never replaces one.
class TakeFile {
  public:
    /// Throws Error if there is such a file, or none can be made.
    explicit TakeFile(const std::filesystem::path& path);
    ~TakeFile();
    TakeFile(const TakeFile&) = delete;
    TakeFile& operator=(const TakeFile&) = delete;

    AVIOContext* io() { return io_; }
    std::uint64_t bytes() const { return static_cast<std::uint64_t>(end_); }
    /// The system's reason for the first write that failed, or for what was written and did not get
    /// to the disk; 0: there is none.
    int failure() const { return failure_; }
    /// What is written so far is whole...
    void mark_whole() { whole_ = end_; }
    /// ...and what came after it is taken off again.
    void cut_to_whole();
    /// Waits until it is on the disk.
    void sync();
    /// Sees to it that it gets there; one at a time, so that what is written meanwhile need not
    /// wait for a slow disk. False: the last one still goes on.
    bool begin_sync();

  private:
#if LIBAVFORMAT_VERSION_MAJOR >= 61  // FFmpeg 7, as in Debian 13
    using WrittenByte = const std::uint8_t;
#else
    using WrittenByte = std::uint8_t;
#endif
    static int write(void* self, WrittenByte* bytes, int size);
    static std::int64_t seek(void* self, std::int64_t offset, int whence);
    /// Keeps what became of the sync that is under way, if one is.
    void take_up_sync();

    UniqueFd fd_;
    AVIOContext* io_ = nullptr;
    std::int64_t at_ = 0, end_ = 0, whole_ = 0;
    int failure_ = 0;
    std::future<int> syncing_;  ///< ends before fd_ does
};

}  // namespace vantage
