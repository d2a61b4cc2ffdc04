#include <cstddef>
#include <cstdint>

#include "common/config/calibration_file.h"
#include "common/config/intrinsics_file.h"
#include "tests/fuzz/seeds/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    const InputFile file(std::span(data, size));
    expect_result_or_error([&] { load_calibration(file.path()); });
    expect_result_or_error([&] { load_intrinsics(file.path()); });
    return 0;
}
