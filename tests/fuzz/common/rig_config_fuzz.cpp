#include <cstddef>
#include <cstdint>

#include "common/config/rig_config.h"
#include "tests/fuzz/seeds/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    const InputFile file(std::span(data, size));
    expect_result_or_error([&] { load_rig_config(file.path()); });
    return 0;
}
