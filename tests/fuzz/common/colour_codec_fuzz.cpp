#include <cstddef>
#include <cstdint>

#include "common/wire/codec/colour_codec.h"
#include "tests/fuzz/seeds/input_file.h"
#include "tests/fuzz/seeds/input_picture.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    static JpegDecoder jpeg;
    static LosslessColourDecoder lossless;
    static LosslessColourEncoder encoder;
    const InputPicture input(std::span(data, size));
    const auto payload = std::as_bytes(input.rest);
    expect_result_or_error([&] { jpeg.decode(payload, input.width_px, input.height_px); });
    expect_result_or_error([&] { lossless.decode(payload, input.width_px, input.height_px); });
    const auto picture = input.pixels<ColourImage>();
    expect_same(lossless.decode(encoder.encode(picture), input.width_px, input.height_px), picture);
    return 0;
}
