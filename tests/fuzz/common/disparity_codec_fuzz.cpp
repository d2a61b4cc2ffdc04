#include <cstddef>
#include <cstdint>

#include "common/wire/codec/disparity_codec.h"
#include "tests/fuzz/seeds/input_file.h"
#include "tests/fuzz/seeds/input_picture.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    static DisparityDecoder decoder;
    static DisparityEncoder encoder;
    const InputPicture input(std::span(data, size));
    expect_result_or_error(
        [&] { decoder.decode(std::as_bytes(input.rest), input.width_px, input.height_px); });
    const auto picture = input.pixels<DisparityImage>();
    expect_same(decoder.decode(encoder.encode(picture), input.width_px, input.height_px), picture);
    return 0;
}
