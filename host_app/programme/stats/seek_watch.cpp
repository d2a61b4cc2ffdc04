#include "host_app/programme/stats/seek_watch.h"

#include <algorithm>
#include <utility>

namespace vantage {

void SeekWatch::follow(std::uint64_t jumps, std::optional<std::uint64_t> stands_at,
                       std::optional<std::uint64_t> shown, MonotonicTime now) {
    const bool is_new = std::exchange(jumps_, jumps) != jumps;
    if (!stands_at)
        seek_.reset();
    else if (is_new && shown && *shown != *stands_at)
        seek_ = {now, *stands_at};
    else if (is_new)
        seek_.reset();
}

void SeekWatch::saw(const ReadyInstant& instant, std::optional<std::uint64_t> stands_at,
                    MonotonicTime now) {
    if (!seek_) return;
    const std::uint64_t wanted = stands_at.value_or(seek_->pulse);
    const std::uint64_t shown = instant.set->trigger_index;
    if (shown < std::min(seek_->pulse, wanted) || shown > std::max(seek_->pulse, wanted)) return;
    const double all_ms = to_ms(now - seek_->since);
    // Work on the instant before the jump does not count.
    const double begun_ms = to_ms(instant.taken_up - seek_->since);
    const double taken_up_ms = std::clamp(begun_ms, 0.0, all_ms);
    const double fetched_ms = std::clamp(begun_ms + instant.fetch_ms, 0.0, all_ms);
    const double prepared_ms =
        std::clamp(begun_ms + instant.fetch_ms + instant.prepare_ms, 0.0, all_ms);
    all_ms_.add(all_ms);
    steps_ms_.wait.add(taken_up_ms);
    steps_ms_.fetch.add(fetched_ms - taken_up_ms);
    steps_ms_.prepare.add(prepared_ms - fetched_ms);
    steps_ms_.picture.add(all_ms - prepared_ms);
    seek_.reset();
}

SeekSteps<Percentiles> SeekWatch::steps_ms() const {
    return {steps_ms_.wait.summary(), steps_ms_.fetch.summary(), steps_ms_.prepare.summary(),
            steps_ms_.picture.summary()};
}

}  // namespace vantage
