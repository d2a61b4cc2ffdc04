#include "common/take/disk_benchmark.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include <unistd.h>

#include "common/base/error.h"
#include "common/base/files/unique_fd.h"
#include "common/base/time/time.h"

namespace vantage {
namespace {

constexpr std::size_t piece_bytes = 4 << 20;
constexpr std::size_t most_bytes = 64 << 20;
constexpr std::chrono::milliseconds longest{300};

}  // namespace

double measure_disk_mb_s(const std::filesystem::path& folder) {
    std::string name = (folder / ".vantage-disk-XXXXXX").string();
    const UniqueFd file(mkstemp(name.data()));
    if (!file) fail("cannot write to {}: {}", folder.string(), std::strerror(errno));
    ::unlink(name.c_str());
    // Random data, since disks that compress would be fast with zeros.
    std::vector<std::uint32_t> piece(piece_bytes / sizeof(std::uint32_t));
    std::uint32_t noise = 1;
    for (std::uint32_t& word : piece) word = noise = noise * 1664525u + 1013904223u;
    const MonotonicTime start = MonotonicClock::now();
    std::size_t written = 0;
    while (written < most_bytes && MonotonicClock::now() - start < longest) {
        const ssize_t n = ::write(file.get(), piece.data(), piece_bytes);
        if (n < 0) fail("cannot write to {}: {}", folder.string(), std::strerror(errno));
        written += static_cast<std::size_t>(n);
        ::fdatasync(file.get());
    }
    const double seconds = std::chrono::duration<double>(MonotonicClock::now() - start).count();
    return static_cast<double>(written) / 1e6 / seconds;
}

double free_disk_mb(const std::filesystem::path& folder) {
    std::error_code error;
    const std::filesystem::space_info space = std::filesystem::space(folder, error);
    if (error) fail("cannot write to {}: {}", folder.string(), error.message());
    return static_cast<double>(space.available) / 1e6;
}

}  // namespace vantage
