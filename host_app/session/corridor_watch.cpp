#include "host_app/session/corridor_watch.h"

#include "common/base/log.h"

namespace vantage {

void CorridorWatch::tell(const LiveShow& show) {
    check_move(show);
    const std::optional<Coverage> now = show.controls().lines().corridor.now;
    if (!now) return;
    const double percent = 100 * now->share;
    const char* lost = words_of(now->loss);
    switch (Corridor::place_of(now->share)) {
        case CorridorPlace::inside:
            break;
        case CorridorPlace::edge:
            if (!std::exchange(told_edge_, true))
                log_warning(
                    "the camera nears the end of what the rigs cover: {:.0f} % of its picture; "
                    "most "
                    "of the rest {}",
                    percent, lost);
            break;
        case CorridorPlace::beyond:
            if (!std::exchange(told_beyond_, true))
                log_warning(
                    "the camera is beyond what the rigs cover: {:.0f} % of its picture; "
                    "most of the rest {}",
                    percent, lost);
            break;
    }
}

void CorridorWatch::check_move(const LiveShow& show) {
    if (!move_) return;
    const std::shared_ptr<const Corridor> corridor = show.corridor();
    if (!corridor) return;
    parts_ = vantage::uncovered_parts(*move_, *corridor);
    move_.reset();
    for (const UncoveredPart& part : parts_)
        log_warning(
            "the planned move is beyond what the rigs cover from {:.1f} to {:.1f} s: at worst "
            "{:.0f} % of its picture is covered, and most of the rest {}",
            part.from_s, part.to_s, 100 * part.least.share, words_of(part.least.loss));
}

}  // namespace vantage
