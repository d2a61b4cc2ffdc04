#include <cstddef>
#include <cstdint>

#include "common/sync/sync_file.h"
#include "tests/fuzz/seeds/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    const InputFile file(std::span(data, size));
    expect_result_or_error([&] { load_sync(file.path()); });
    return 0;
}
