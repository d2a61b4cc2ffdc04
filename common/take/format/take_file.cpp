#include "common/take/format/take_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"

namespace vantage {
namespace {

constexpr int buffer_bytes = 256 * 1024;

}  // namespace

TakeFile::TakeFile(const std::filesystem::path& path)
    : fd_(::open(path.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0644)) {
    if (!fd_ && errno == EEXIST)
        fail("{} exists, and a take never replaces a file: choose another name", path.string());
    if (!fd_) fail("cannot write {}: {}", path.string(), std::strerror(errno));
    auto* buffer = static_cast<std::uint8_t*>(av_malloc(buffer_bytes));
    io_ = avio_alloc_context(buffer, buffer_bytes, 1, this, nullptr, write, seek);
    if (!io_) fail("cannot write {}: out of memory", path.string());
}

TakeFile::~TakeFile() {
    if (io_) av_freep(&io_->buffer);
    avio_context_free(&io_);
}

int TakeFile::write(void* opaque, WrittenByte* bytes, int size) {
    TakeFile& self = *static_cast<TakeFile*>(opaque);
    // After a failure nothing more is written, so that the file stays readable.
    if (self.failure_ != 0) return AVERROR(self.failure_);
    for (int done = 0; done < size;) {
        const ssize_t n =
            ::pwrite(self.fd_.get(), bytes + done, static_cast<std::size_t>(size - done), self.at_);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) {
            self.failure_ = n < 0 ? errno : ENOSPC;
            return AVERROR(self.failure_);
        }
        done += static_cast<int>(n);
        self.at_ += n;
        self.end_ = std::max(self.end_, self.at_);
    }
    return size;
}

std::int64_t TakeFile::seek(void* opaque, std::int64_t offset, int whence) {
    TakeFile& self = *static_cast<TakeFile*>(opaque);
    switch (whence & ~AVSEEK_FORCE) {
        case AVSEEK_SIZE:
            return self.end_;
        case SEEK_SET:
            self.at_ = offset;
            break;
        case SEEK_CUR:
            self.at_ += offset;
            break;
        case SEEK_END:
            self.at_ = self.end_ + offset;
            break;
        default:
            return AVERROR(EINVAL);
    }
    return self.at_;
}

void TakeFile::cut_to_whole() {
    if (::ftruncate(fd_.get(), whole_) == 0) end_ = whole_;
}

void TakeFile::take_up_sync() {
    const int reason = syncing_.valid() ? syncing_.get() : 0;
    if (failure_ == 0) failure_ = reason;
}

void TakeFile::sync() {
    take_up_sync();
    if (failure_ == 0) failure_ = sync_data(fd_.get());
}

bool TakeFile::is_syncing() const {
    return syncing_.valid() &&
           syncing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
}

bool TakeFile::begin_sync() {
    if (is_syncing()) return false;
    take_up_sync();
    syncing_ = std::async(std::launch::async, [fd = fd_.get()] { return sync_data(fd); });
    return true;
}

}  // namespace vantage
