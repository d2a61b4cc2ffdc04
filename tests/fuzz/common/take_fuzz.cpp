#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>

extern "C" {
#include <libavutil/log.h>
}

#include "common/take/format/frame_storage.h"
#include "common/take/take_reader.h"
#include "tests/fuzz/seeds/input_file.h"
#include "tests/fuzz/seeds/seed_frames.h"

namespace vantage {
namespace {

/// What stands behind checksums: somebody may have made those too.
void read_sealed(std::span<const std::byte> bytes) {
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    expect_result_or_error([&] { take_facts_from(text); });
    expect_result_or_error([&] { frame_record_from(seal_record(text)); });
    expect_result_or_error([&] { camera_record_from(seal_record(text)); });
    expect_result_or_error([&] { sound_record_from(seal_record(text)); });
    RigFrame frame = seed_frame();
    const PackedFrame packed = FrameEncoder(85).encode(frame);
    static const TakeRig rig = take_rig_of(decode_frame_head(packed.header));
    static FrameRestorer restorer(rig);
    StoredFrame stored;
    stored.record.header = packed.header;
    stored.colour = packed.colour;
    stored.depth.assign(bytes.begin(), bytes.end());
    expect_result_or_error([&] { restorer.restore(stored); });
}

}  // namespace
}  // namespace vantage

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    av_log_set_level(AV_LOG_QUIET);
    read_sealed(std::as_bytes(std::span(data, size)));
    const InputFile file({data, size});
    expect_result_or_error([&] {
        const TakeReader reader(file.path());
        std::int64_t heard = 0;
        for (const TakeReader::Sound& sound : reader.sounds()) {
            // Whoever plays it looks for a sample among blocks in their order.
            if (sound.first < heard || sound.count == 0) std::abort();
            heard = sound.end();
            expect_result_or_error([&] {
                if (sound_from_stored(reader.load(sound)).size() != sound_channels * sound.count)
                    std::abort();
            });
        }
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
