#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "host_app/desk/desk_arrangement.h"
#include "tests/fuzz/seeds/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    const InputFile file(std::span(data, size));
    expect_result_or_error([&] {
        const DeskArrangement desk = load_desk(file.path());
        if (desk.window && (desk.window->width < 1 || desk.window->height < 1)) std::abort();
    });
    return 0;
}
