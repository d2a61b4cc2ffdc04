#include "common/take/take_check.h"

#include <algorithm>
#include <cmath>

#include "common/base/error.h"
#include "common/take/take_pulses.h"

namespace vantage {
namespace {

void add(std::string& text, std::uint64_t before, std::uint64_t after, const char* what) {
    if (after > before)
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", after - before, what);
}

/// What became of the frames between two of a rig.
std::string why_of(const TakeReader::Frame& before, const TakeReader::Frame& after) {
    if (before.session != after.session) return "the rig was started anew";
    std::string text;
    add(text, before.rig.missed, after.rig.missed, "missed by the rig");
    add(text, before.rig.late, after.rig.late, "late at the rig");
    add(text, before.link.send_dropped, after.link.send_dropped, "pushed out on the way");
    add(text, before.link.thinned, after.link.thinned, "not asked for");
    add(text, before.dropped, after.dropped, "left out by the recording host");
    return text;
}

/// Before frame `i`. A rig counts while a frame is still on its way to be packed, so the one before
/// the gap may know of it already.
std::string why_of(const std::vector<TakeReader::Frame>& frames, std::size_t i) {
    const std::string why = why_of(frames[i - 1], frames[i]);
    return why.empty() && i >= 2 ? why_of(frames[i - 2], frames[i - 1]) : why;
}

void find_gaps(const TakeReader& take, std::size_t rig, std::uint64_t first, std::uint64_t last,
               std::vector<TakeGap>& gaps) {
    const std::string& name = take.facts().rigs[rig].name;
    const std::vector<TakeReader::Frame>& frames = take.frames(rig);
    const auto ragged = static_cast<std::uint64_t>(std::ceil(take.facts().pulse_rate_hz));
    if (frames.empty()) {
        gaps.push_back({name, first, last, "the rig is in none of the take"});
        return;
    }
    if (frames.front().pulse - first > ragged)
        gaps.push_back({name, first, frames.front().pulse - 1, "the rig came later"});
    for (std::size_t i = 1; i < frames.size(); ++i)
        if (frames[i].pulse > frames[i - 1].pulse + 1)
            gaps.push_back({name, frames[i - 1].pulse + 1, frames[i].pulse - 1, why_of(frames, i)});
    if (last - frames.back().pulse > ragged)
        gaps.push_back({name, frames.back().pulse + 1, last, "the rig went earlier"});
}

}  // namespace

TakeVerdict check_take(const TakeReader& take, const std::function<void(double)>& progress) {
    TakeVerdict verdict;
    verdict.damage = take.damage();
    std::uint64_t all = 0, done = 0;
    for (std::size_t rig = 0; rig < take.facts().rigs.size(); ++rig) all += take.frames(rig).size();
    const PulseSpan span = all > 0 ? pulse_span_of(take) : PulseSpan();
    for (std::size_t rig = 0; rig < take.facts().rigs.size(); ++rig) {
        if (all > 0) find_gaps(take, rig, span.first, span.last, verdict.gaps);
        for (const TakeReader::Frame& frame : take.frames(rig)) {
            try {
                take.load(rig, frame);
                ++verdict.frames;
            } catch (const Error& error) {
                verdict.damage.push_back({frame.record.at, error.what()});
            }
            constexpr std::uint64_t now_and_then = 500;
            if (++done % now_and_then == 0 && progress)
                progress(static_cast<double>(done) / static_cast<double>(all));
        }
    }
    return verdict;
}

}  // namespace vantage
