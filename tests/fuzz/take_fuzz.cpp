#include <cstddef>
#include <cstdint>
#include <optional>

extern "C" {
#include <libavutil/log.h>
}

#include "common/take/frame_storage.h"
#include "common/take/take_reader.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    av_log_set_level(AV_LOG_QUIET);
    const InputFile file({data, size});
    expect_result_or_error([&] {
        const TakeReader reader(file.path());
        for (std::size_t rig = 0; rig < reader.facts().rigs.size(); ++rig) {
            std::optional<FrameRestorer> restorer;
            for (const TakeReader::Frame& frame : reader.frames(rig))
                expect_result_or_error([&] {
                    if (!restorer) restorer.emplace(reader.facts().rigs[rig]);
                    restorer->restore(reader.load(rig, frame));
                });
        }
    });
    return 0;
}
