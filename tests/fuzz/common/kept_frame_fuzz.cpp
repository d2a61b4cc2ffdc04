#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "common/take/kept_frame.h"
#include "tests/fuzz/seeds/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    if (size < 2) return 0;
    const auto bytes = std::as_bytes(std::span(data, size));
    // The length of the head, the head, the record without its seal; both pictures are one byte.
    const std::size_t head_size = std::min<std::size_t>(
        std::to_integer<std::size_t>(bytes[0]) | std::to_integer<std::size_t>(bytes[1]) << 8,
        size - 2);
    KeptParts parts;
    parts.head.assign(bytes.begin() + 2,
                      bytes.begin() + 2 + static_cast<std::ptrdiff_t>(head_size));
    // What stands behind a checksum: somebody may have made that too.
    const std::string record =
        seal_record({reinterpret_cast<const char*>(data) + 2 + head_size, size - 2 - head_size});
    const auto record_bytes = std::as_bytes(std::span(record));
    parts.record.assign(record_bytes.begin(), record_bytes.end());
    parts.colour = parts.depth = {std::byte{1}};
    expect_result_or_error([&] {
        const KeptFrame frame = decode_kept_frame(parts);
        const KeptFrame again = decode_kept_frame(encode(frame));
        if (again.rig != frame.rig || to_text(again.frame.record) != to_text(frame.frame.record))
            std::abort();
    });
    return 0;
}
