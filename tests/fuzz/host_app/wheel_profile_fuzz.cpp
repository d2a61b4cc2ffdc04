#include <cstddef>
#include <cstdint>
#include <string_view>

#include "host_app/control/hid/wheel_profile.h"
#include "tests/fuzz/seeds/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    expect_result_or_error([&] { read_wheel_profile(text, "wheel.toml"); });
    return 0;
}
