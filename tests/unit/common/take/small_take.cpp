#include "tests/unit/common/take/small_take.h"

#include <algorithm>
#include <deque>

#include "common/base/files/atomic_file.h"
#include "common/base/time/pulse_grid.h"
#include "tests/support/wire_frames.h"

namespace vantage {

static constexpr double small_take_rate_hz = 25;

PackedFrame sent_frame(const std::string& rig, std::uint64_t pulse, int jpeg_quality) {
    RigFrame frame = make_frame(pulse, 62, 46);
    frame.rig = rig;
    frame.exposure = PulseGrid(small_take_rate_hz).time_of(pulse);
    frame.counters.captured = pulse;
    frame.counters.published = pulse;
    if (pulse % 4 == 0) frame.right = make_frame(pulse + 1, 62, 46).colour;
    return FrameEncoder(jpeg_quality).encode(frame);
}

TakeFacts small_facts(const std::vector<std::string>& rigs, std::uint64_t first, int jpeg_quality) {
    TakeFacts facts;
    facts.pulse_rate_hz = small_take_rate_hz;
    facts.origin = PulseGrid(small_take_rate_hz).time_of(first);
    facts.program = "a test";
    facts.timecode = "10:00:00:00";
    facts.show = {{"timecode_zone", "UTC"}};
    for (const std::string& rig : rigs)
        facts.rigs.push_back(
            take_rig_of(decode_frame_head(sent_frame(rig, first, jpeg_quality).header)));
    return facts;
}

void write_small_take(const std::filesystem::path& path, const std::vector<std::string>& rigs,
                      std::uint64_t first, std::uint64_t last,
                      const std::vector<std::uint64_t>& gaps) {
    TakeWriter writer(path, small_facts(rigs, first));
    std::deque<FrameStorer> storers;
    for (const TakeRig& rig : writer.facts().rigs) storers.emplace_back(rig);
    for (std::uint64_t pulse = first; pulse <= last; ++pulse)
        for (std::size_t rig = 0; rig < rigs.size(); ++rig)
            if (rig + 1 < rigs.size() || std::find(gaps.begin(), gaps.end(), pulse) == gaps.end())
                writer.add(rig, storers[rig].store(sent_frame(rigs[rig], pulse)));
    writer.finish();
}

std::vector<std::byte> bytes_of_file(const std::filesystem::path& path) {
    return read_file(path, 1 << 30);
}

void write_bytes(const std::filesystem::path& path, std::span<const std::byte> bytes) {
    write_file_atomically(path, bytes);
}

}  // namespace vantage
