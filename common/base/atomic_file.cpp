#include "common/base/atomic_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>

#include <unistd.h>

#include "common/base/error.h"

namespace vantage {

void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes) {
    const std::filesystem::path temporary = path.string() + fmt::format(".partial-{}", getpid());
    {
        std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
        if (!out) fail("cannot write {}: {}", path.string(), std::strerror(errno));
        out.write(reinterpret_cast<const char*>(bytes.data()),
                  static_cast<std::streamsize>(bytes.size()));
        out.close();
        if (!out) {
            const int reason = errno;
            std::error_code ignored;
            std::filesystem::remove(temporary, ignored);
            fail("cannot write {}: {}", path.string(), std::strerror(reason));
        }
    }
    std::error_code error;
    std::filesystem::rename(temporary, path, error);
    if (error) {
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
        fail("cannot write {}: {}", path.string(), error.message());
    }
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

}  // namespace vantage
