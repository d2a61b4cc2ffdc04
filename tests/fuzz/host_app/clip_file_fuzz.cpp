#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "host_app/replay/clip.h"
#include "tests/fuzz/seeds/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    const InputFile file(std::span(data, size));
    expect_result_or_error([&] {
        for (const PlayEntry& entry : load_clips(file.path(), 25).list)
            if (entry.clip < 1 || entry.clip > most_clips) std::abort();
    });
    return 0;
}
