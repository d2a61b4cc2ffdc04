#include <cstddef>
#include <cstdint>

#include "common/wire/frame_codec.h"
#include "tests/fuzz/seeds/input_file.h"
#include "tests/fuzz/seeds/seed_frames.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    static FrameDecoder decoder;
    const SeedParts parts = split_frame(std::as_bytes(std::span(data, size)));
    expect_result_or_error([&] { decoder.decode(parts.header, parts.colour, parts.disparity); });
    return 0;
}
