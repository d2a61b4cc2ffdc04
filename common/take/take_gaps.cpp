#include "common/take/take_gaps.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

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

}  // namespace vantage
