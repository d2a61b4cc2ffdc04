#include <cstddef>
#include <cstdint>

#include "host_app/background/background_file.h"
#include "tests/fuzz/seeds/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    expect_result_or_error([&] { decode_background(std::as_bytes(std::span(data, size))); });
    return 0;
}
