#include "host_app/pipeline/instant_stats.h"

#include <utility>

namespace vantage {

void InstantStatsRecorder::drop_locked() {
    if (!unprepared_) return;
    ++dropped_.sets;
    count_frames(*unprepared_, dropped_.frames);
    unprepared_.reset();
}

void InstantStatsRecorder::note_prepared(Prepared prepared) {
    unprepared_.reset();
    const std::lock_guard lock(mutex_);
    if (prepared.is_interpolated) ++stats_.between;
    if (prepared.is_counted) {
        ++stats_.prepared;
        count_frames(prepared.set, stats_.frames);
        for (const FrameSet::Slot& slot : prepared.set.slots) {
            if (!slot.frame) continue;
            capture_ms_.add(slot.frame->times.capture_ms);
            rectify_ms_.add(slot.frame->times.rectify_ms);
            match_ms_.add(slot.frame->times.match_ms);
            pack_ms_.add(slot.frame->times.pack_ms);
        }
    }
    stats_.gain_compensation = std::move(prepared.gain_compensation);
    stats_.backgrounds = std::move(prepared.backgrounds);
    prepare_ms_.add(prepared.prepare_ms);
}

InstantStats InstantStatsRecorder::snapshot(NewestFrameSet::Replaced replaced) const {
    const std::lock_guard lock(mutex_);
    InstantStats stats = stats_;
    stats.replaced = std::move(replaced);
    stats.replaced.sets += dropped_.sets;
    for (const auto& [rig, frames] : dropped_.frames) stats.replaced.frames[rig] += frames;
    stats.prepare_ms = prepare_ms_.summary();
    stats.rig_steps = {capture_ms_.summary(), rectify_ms_.summary(), match_ms_.summary(),
                       pack_ms_.summary()};
    return stats;
}

}  // namespace vantage
