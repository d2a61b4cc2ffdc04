#include <cstddef>
#include <cstdint>

#include "common/config/stage_config.h"
#include "tests/fuzz/seeds/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    const InputFile file(std::span(data, size));
    expect_result_or_error([&] { load_stage_config(file.path()); });
    expect_result_or_error([&] {
        stage_flight_from({reinterpret_cast<const char*>(data), size}, "stage.toml");
    });
    return 0;
}
