#include <cstddef>
#include <cstdint>

#include "host_app/flight/moves/move.h"
#include "tests/fuzz/seeds/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    const InputFile file(std::span(data, size));
    expect_result_or_error([&] { Move::load(file.path()); });
    return 0;
}
