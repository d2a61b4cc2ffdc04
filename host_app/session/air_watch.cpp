#include "host_app/session/air_watch.h"

#include "host_app/desk/feed/desk_values.h"
#include "host_app/session/report/rig_words.h"

namespace vantage {

const char* key_of(AirVerdict::Level level) {
    switch (level) {
        case AirVerdict::Level::ready:
            return "ready";
        case AirVerdict::Level::caution:
            return "caution";
        case AirVerdict::Level::not_ready:
            break;
    }
    return "not_ready";
}

bool AirWatch::follow(const LiveShow& show, const std::optional<TakeState>& take,
                      MonotonicTime now) {
    constexpr std::chrono::milliseconds period{250};
    if (seen_ && now - refreshed_ < period) return false;
    refreshed_ = now;
    const ProgrammeState programme = show.state();
    Seen seen;
    seen.report = show.report();
    const FrameSet* set = programme.picture ? programme.picture->job.instant->set.get() : nullptr;
    ticks_.add(seen.report.programme.ticks, now);
    repeats_.add(seen.report.programme.repeated, now);
    // The part of the desk's values that the verdict is made of.
    DeskState desk;
    desk.waiting = set == nullptr;
    desk.has_frame_sets = show.settings().take || seen.report.frame_sets_closed > 0;
    desk.signal = seen.report.signal;
    desk.age_s = live_age_s(programme);
    if (show.settings().take) desk.time.emplace().is_of_take = true;
    if (seen.report.signal != SignalState::no_signal) desk.coverage = seen.report.corridor.now;
    desk.tick_rate_hz = ticks_.per_second();
    desk.repeat_rate_hz = repeats_.per_second();
    if (take) desk.take.emplace().failure = take->failure;
    for (const RigAccount& account : seen.report.rigs) {
        DeskRig& rig = desk.rigs.emplace_back();
        rig.name = account.status.rig;
        rig.state = state_in(set, account.status);
        const auto last = rigs_seen_.try_emplace(rig.name, now).first;
        if (rig.state == RigState::present) last->second = now;
        rig.absent_s = std::chrono::duration<double>(now - last->second).count();
        rig.worries = worries_of(account.status);
    }
    for (const OutputState& output : seen.report.outputs) {
        DeskOutput& shown = desk.outputs.emplace_back();
        shown.name = output.name;
        shown.is_failed = output.phase == OutputPhase::failed;
    }
    seen.verdict = air_verdict(desk);
    seen.rigs = std::move(desk.rigs);
    seen_ = std::move(seen);
    return true;
}

}  // namespace vantage
