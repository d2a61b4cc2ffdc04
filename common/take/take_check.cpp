#include "common/take/take_check.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "common/base/error.h"
#include "common/base/time/pulse_grid.h"
#include "common/take/take_pulses.h"

namespace vantage {
namespace {

constexpr std::array reasons{"missed by the rig", "late at the rig", "dropped at the rig",
                             "skipped (not requested)", "dropped by the recording host"};
using Losses = std::array<std::uint64_t, reasons.size()>;

/// How many losses may be known before their gap, and how many frames after a gap may explain it:
/// more than are on their way at a time. Joined takes exceed this.
constexpr std::uint64_t most_ahead = 32;
constexpr std::size_t most_frames_later = 8;

Losses losses_of(const TakeReader::Frame& frame) {
    return {frame.rig.missed, frame.rig.late, frame.link.send_dropped, frame.link.skipped,
            frame.dropped};
}

struct Gap {
    TakeGap gap;
    std::size_t frame;  ///< index of the frame after the gap
    std::uint64_t unexplained;
    Losses losses{};
};

void explain(Gap& gap, Losses& known) {
    for (std::size_t reason = 0; reason < known.size(); ++reason) {
        const std::uint64_t dealt = std::min(known[reason], gap.unexplained);
        known[reason] -= dealt;
        gap.losses[reason] += dealt;
        gap.unexplained -= dealt;
    }
}

std::string words_for(const Losses& losses) {
    std::string text;
    for (std::size_t reason = 0; reason < losses.size(); ++reason)
        if (losses[reason] > 0)
            text +=
                fmt::format("{}{} {}", text.empty() ? "" : ", ", losses[reason], reasons[reason]);
    return text;
}

void find_gaps(const TakeReader& take, std::size_t rig, std::uint64_t first, std::uint64_t last,
               std::vector<TakeGap>& gaps) {
    const std::string& name = take.facts().rigs[rig].name;
    const std::vector<TakeReader::Frame>& frames = take.frames(rig);
    const auto ragged = static_cast<std::uint64_t>(std::ceil(take.facts().pulse_rate_hz));
    if (frames.empty()) {
        gaps.push_back({name, first, last, "the rig has no frame in the take"});
        return;
    }
    if (frames.front().pulse - first > ragged)
        gaps.push_back({name, first, frames.front().pulse - 1, "the rig came later"});
    for (TakeGap& gap : gaps_between(name, frames)) gaps.push_back(std::move(gap));
    if (last - frames.back().pulse > ragged)
        gaps.push_back({name, frames.back().pulse + 1, last, "the rig went earlier"});
}

void look_at_sound(const TakeReader& take, const PulseSpan& span, TakeVerdict& verdict) {
    if (!take.facts().has_sound) return;
    const PulseGrid pulses(take.facts().pulse_rate_hz);
    // A programme has no sound before its first picture. A begin or end within a second is no gap.
    TaiTime begin = pulses.time_of(span.first);
    if (!take.cameras().empty()) begin = std::max(begin, take.cameras().front().time);
    std::int64_t end = sound_sample_at(begin) + sound_rate_hz;
    const std::int64_t last = sound_sample_at(pulses.time_of(span.last)) - sound_rate_hz;
    const auto add_gap = [&](std::int64_t from, std::int64_t to) {
        if (to > from)
            verdict.sound_gaps.push_back(
                {time_of_sound(from), static_cast<double>(to - from) / sound_rate_hz});
    };
    for (const TakeReader::Sound& sound : take.sounds()) {
        add_gap(end, sound.first);
        end = sound.end();
        try {
            take.load(sound);
            verdict.sound_s += static_cast<double>(sound.count) / sound_rate_hz;
        } catch (const Error& error) {
            verdict.damage.push_back({sound.record.at, error.what()});
        }
    }
    add_gap(end, last);
}

}  // namespace

std::vector<TakeGap> gaps_between(const std::string& rig,
                                  std::span<const TakeReader::Frame> frames) {
    std::vector<Gap> gaps;
    std::size_t first_open = 0;  // in `gaps`: earlier ones are explained as far as possible
    Losses known{};
    for (std::size_t i = 1; i < frames.size(); ++i) {
        const TakeReader::Frame &before = frames[i - 1], &after = frames[i];
        const bool is_anew = before.session != after.session;
        if (is_anew) {
            known = {};
            first_open = gaps.size();
        } else {
            const Losses counted = losses_of(before), now = losses_of(after);
            for (std::size_t reason = 0; reason < known.size(); ++reason)
                if (now[reason] > counted[reason])
                    known[reason] = std::min(known[reason] + now[reason] - counted[reason],
                                             after.pulse - before.pulse + most_ahead);
        }
        if (after.pulse > before.pulse + 1) {
            gaps.push_back({{rig, before.pulse + 1, after.pulse - 1, ""}, i, 0});
            if (is_anew) {
                gaps.back().gap.why = "the rig was restarted";
                first_open = gaps.size();
            } else {
                gaps.back().unexplained = gaps.back().gap.pulses();
            }
        }
        while (first_open < gaps.size() && gaps[first_open].frame + most_frames_later < i)
            ++first_open;
        for (std::size_t open = gaps.size(); open > first_open; --open)
            explain(gaps[open - 1], known);
    }
    std::vector<TakeGap> explained;
    for (Gap& each : gaps) {
        if (each.gap.why.empty()) each.gap.why = words_for(each.losses);
        explained.push_back(std::move(each.gap));
    }
    return explained;
}

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
    if (all > 0) look_at_sound(take, span, verdict);
    return verdict;
}

}  // namespace vantage
