#include "common/take/format/ebml_file.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/base/error.h"

namespace vantage {
namespace {

/// Element heads that lie close together are read in one go.
constexpr std::size_t window_bytes = 4096;
constexpr std::size_t search_bytes = 1 << 20;
constexpr std::size_t longest_head = 12;

}  // namespace

EbmlFile::EbmlFile(const std::filesystem::path& path)
    : path_(path), fd_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (!fd_) fail("cannot read {}: {}", path_.string(), std::strerror(errno));
    struct stat facts {};
    if (fstat(fd_.get(), &facts) != 0 || !S_ISREG(facts.st_mode))
        fail("cannot read {}: it is not a file", path_.string());
    size_ = static_cast<std::uint64_t>(facts.st_size);
}

std::vector<std::byte> EbmlFile::bytes(std::uint64_t at, std::size_t count) const {
    if (at > size_ || count > size_ - at)
        fail("{} ends before the {} bytes at {}", path_.string(), count, at);
    std::vector<std::byte> read(count);
    for (std::size_t done = 0; done < count;) {
        const ssize_t n =
            ::pread(fd_.get(), read.data() + done, count - done, static_cast<off_t>(at + done));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) fail("cannot read {} at {}: {}", path_.string(), at, std::strerror(errno));
        if (n == 0) fail("{} was truncated while it was read", path_.string());
        done += static_cast<std::size_t>(n);
    }
    return read;
}

std::span<const std::byte> EbmlFile::window(std::uint64_t at, std::size_t count) {
    if (at >= size_) return {};
    count = static_cast<std::size_t>(std::min<std::uint64_t>(count, size_ - at));
    if (at < window_at_ || at + count > window_at_ + window_.size()) {
        window_ = bytes(at, static_cast<std::size_t>(std::min<std::uint64_t>(
                                std::max(count, window_bytes), size_ - at)));
        window_at_ = at;
    }
    return std::span(window_).subspan(static_cast<std::size_t>(at - window_at_), count);
}

std::optional<EbmlFile::VarInt> EbmlFile::var_int(std::span<const std::byte> bytes) {
    if (bytes.empty()) return std::nullopt;
    const auto first = std::to_integer<std::uint8_t>(bytes[0]);
    const auto length = static_cast<std::size_t>(std::countl_zero(first)) + 1;
    if (length > 8 || length > bytes.size()) return std::nullopt;
    VarInt number{first & ((1u << (8 - length)) - 1u), length, false};
    for (std::size_t i = 1; i < length; ++i)
        number.value = number.value << 8 | std::to_integer<std::uint64_t>(bytes[i]);
    number.is_unknown = number.value == (std::uint64_t{1} << (7 * length)) - 1;
    return number;
}

std::optional<EbmlFile::Element> EbmlFile::element(std::uint64_t at, std::uint64_t limit) {
    limit = std::min(limit, size_);
    if (at >= limit) return std::nullopt;
    const std::span<const std::byte> head =
        window(at, static_cast<std::size_t>(std::min<std::uint64_t>(longest_head, limit - at)));
    const std::optional<VarInt> id = var_int(head);
    if (!id || id->length > 4) return std::nullopt;
    const std::optional<VarInt> size = var_int(head.subspan(id->length));
    if (!size) return std::nullopt;
    Element element;
    // An element's identifier includes its length marker.
    element.id = id->value | std::uint64_t{1} << (7 * id->length);
    element.at = at;
    element.inside = at + id->length + size->length;
    element.is_open = size->is_unknown;
    if (!element.is_open && size->value > limit - element.inside) return std::nullopt;
    element.end = element.is_open ? limit : element.inside + size->value;
    return element;
}

std::optional<std::uint64_t> EbmlFile::find(std::uint32_t id, std::uint64_t from) {
    std::byte wanted[4];
    for (int i = 0; i < 4; ++i) wanted[i] = static_cast<std::byte>(id >> (24 - 8 * i));
    while (from < size_) {
        const std::vector<std::byte> part = bytes(
            from, static_cast<std::size_t>(std::min<std::uint64_t>(search_bytes, size_ - from)));
        const auto found = std::search(part.begin(), part.end(), wanted, wanted + 4);
        if (found != part.end()) return from + static_cast<std::uint64_t>(found - part.begin());
        if (part.size() < search_bytes) break;
        from += part.size() - 3;
    }
    return std::nullopt;
}

std::optional<std::uint64_t> EbmlFile::number(const Element& element) {
    const std::uint64_t length = element.end - element.inside;
    if (length > 8) return std::nullopt;
    std::uint64_t value = 0;
    for (const std::byte byte : window(element.inside, static_cast<std::size_t>(length)))
        value = value << 8 | std::to_integer<std::uint64_t>(byte);
    return value;
}

}  // namespace vantage
