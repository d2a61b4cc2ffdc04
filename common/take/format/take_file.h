#pragma once

#include <cstdint>
#include <filesystem>
#include <future>

#include "common/av/av_handles.h"
#include "common/base/files/unique_fd.h"

namespace vantage {

/// A new file that libavformat writes through. Never replaces a file. Not thread-safe.
class TakeFile {
  public:
    /// Throws Error if the file exists or cannot be created.
    explicit TakeFile(const std::filesystem::path& path);
    ~TakeFile();
    TakeFile(const TakeFile&) = delete;
    TakeFile& operator=(const TakeFile&) = delete;

    AVIOContext* io() { return io_; }
    std::uint64_t bytes() const { return static_cast<std::uint64_t>(end_); }
    /// errno of the first failed write, or of data that did not reach the disk; 0: none.
    int failure() const { return failure_; }
    /// Marks the end of what is written so far as a good end...
    void mark_whole() { whole_ = end_; }
    /// ...and truncates the file to the last mark.
    void cut_to_whole();
    /// Waits until the data is on disk.
    void sync();
    /// Starts a sync on another thread, so that writing does not wait for a slow disk. False: the
    /// last one still runs.
    bool begin_sync();
    /// Whether one still runs.
    bool is_syncing() const;

  private:
#if LIBAVFORMAT_VERSION_MAJOR >= 61  // FFmpeg 7, as in Debian 13
    using WrittenByte = const std::uint8_t;
#else
    using WrittenByte = std::uint8_t;
#endif
    static int write(void* self, WrittenByte* bytes, int size);
    static std::int64_t seek(void* self, std::int64_t offset, int whence);
    /// Stores the result of a finished sync.
    void take_up_sync();

    UniqueFd fd_;
    AVIOContext* io_ = nullptr;
    std::int64_t at_ = 0, end_ = 0, whole_ = 0;
    int failure_ = 0;
    std::future<int> syncing_;  ///< has to end before fd_ does
};

}  // namespace vantage
