#include "common/base/files/atomic_file.h"

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>

#include <fcntl.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/files/unique_fd.h"

namespace vantage {
namespace {

/// Writes and syncs a file. Returns 0, or the errno of the step that failed.
int write_whole(const std::filesystem::path& path, std::span<const std::byte> bytes) {
    const UniqueFd file(
        ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666));
    if (!file) return errno;
    while (!bytes.empty()) {
        const ssize_t written = ::write(file.get(), bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    // Without fsync(), a power cut after the rename could leave an empty file at the target.
    return ::fsync(file.get()) == 0 ? 0 : errno;
}

}  // namespace

void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes) {
    // A name per thread, since several threads may write the same path.
    const std::filesystem::path temporary = path.string() + fmt::format(".partial-{}", gettid());
    int reason = write_whole(temporary, bytes);
    if (reason == 0 && ::rename(temporary.c_str(), path.c_str()) != 0) reason = errno;
    if (reason == 0) return;
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    fail("cannot write {}: {}", path.string(), std::strerror(reason));
}

std::vector<std::byte> read_file(const std::filesystem::path& path, std::size_t max_bytes) {
    std::error_code error;
    if (std::filesystem::is_directory(path, error))
        fail("{} is a folder, not a file", path.string());
    const auto size = std::filesystem::file_size(path, error);
    if (error) fail("cannot read {}: {}", path.string(), error.message());
    if (size > max_bytes)
        fail("{} has {} bytes, more than the limit of {}", path.string(), size, max_bytes);
    std::vector<std::byte> bytes(size);
    std::ifstream in(path, std::ios::binary);
    if (!in) fail("cannot read {}: {}", path.string(), std::strerror(errno));
    in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (static_cast<std::uintmax_t>(in.gcount()) != size)
        fail("{} became shorter while it was read", path.string());
    return bytes;
}

void write_text_atomically(const std::filesystem::path& path, std::string_view text) {
    write_file_atomically(path, std::as_bytes(std::span(text)));
}

std::string read_text_file(const std::filesystem::path& path, std::size_t max_bytes) {
    const std::vector<std::byte> bytes = read_file(path, max_bytes);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

int sync_data(int fd) {
    if (::fdatasync(fd) == 0 || errno == EINVAL || errno == ENOSYS) return 0;
    return errno;
}

}  // namespace vantage
