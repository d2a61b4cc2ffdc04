#include "host_app/output/media/mp4_fragments.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <string_view>

#include "common/base/error.h"

namespace vantage {
namespace {

/// Header of a top-level box: ISO/IEC 14496-12, 4.2.
struct BoxHead {
    std::uint64_t bytes = 0;  ///< 0: until the end of the file
    std::array<char, 4> type{};

    std::string_view name() const { return {type.data(), type.size()}; }
};

std::uint64_t big_endian(std::istream& in, int bytes) {
    std::uint64_t value = 0;
    for (int i = 0; i < bytes; ++i) value = value << 8 | static_cast<std::uint64_t>(in.get() & 255);
    return value;
}

BoxHead read_head(std::istream& in) {
    BoxHead head;
    head.bytes = big_endian(in, 4);
    in.read(head.type.data(), head.type.size());
    constexpr std::uint64_t size_follows = 1;
    if (head.bytes == size_follows) head.bytes = big_endian(in, 8);
    return head;
}

}  // namespace

void cut_to_whole_fragments(const std::filesystem::path& path) {
    std::error_code error;
    const std::uint64_t file_bytes = std::filesystem::file_size(path, error);
    std::ifstream in(path, std::ios::binary);
    if (error || !in) fail("cannot read {}", path.string());
    // A fragment consists of a `moof` box and the `mdat` box after it.
    std::uint64_t whole = 0;
    for (std::uint64_t at = 0; at < file_bytes;) {
        in.seekg(static_cast<std::streamoff>(at));
        const BoxHead head = read_head(in);
        constexpr std::uint64_t least_box = 8;
        if (!in || head.bytes < least_box || head.bytes > file_bytes - at) break;
        at += head.bytes;
        if (head.name() != "moof") whole = at;
    }
    std::filesystem::resize_file(path, whole, error);
    if (error) fail("cannot cut {}: {}", path.string(), error.message());
}

}  // namespace vantage
