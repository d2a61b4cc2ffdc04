#include "host_app/live/panel_feed.h"

#include <algorithm>

#include <fmt/format.h>

#include "common/gl/limits.h"
#include "host_app/live/live_report.h"
#include "host_app/output/disparity_picture.h"

namespace vantage {
namespace {

constexpr std::chrono::milliseconds refresh_period{250};
constexpr std::size_t latency_samples = 240;

RigState state_in(const FrameSet* set, const RigStatus& status) {
    if (!status.refused.empty()) return RigState::refused;
    if (!status.connected) return RigState::disconnected;
    if (!set) return RigState::late;
    for (const FrameSet::Slot& slot : set->slots) {
        if (slot.rig != status.rig) continue;
        if (slot.frame) return RigState::present;
        if (slot.absence == Absence::missed_by_rig) return RigState::missed;
        if (slot.absence == Absence::disconnected) return RigState::disconnected;
    }
    return RigState::late;
}

bool is_at_rig(const std::string& step) {
    return step == "capture" || step == "rectify" || step == "match" || step == "pack";
}

std::optional<PanelTime> panel_time(const ProgrammeState& programme) {
    if (!programme.time.pulse || !programme.past) return std::nullopt;
    const auto oldest = static_cast<double>(programme.past->oldest);
    const double length = std::max(1.0, static_cast<double>(programme.past->newest) - oldest);
    const auto share = [&](double pulse) {
        return std::clamp((pulse - oldest) / length, 0.0, 1.0);
    };
    PanelTime time;
    time.speed = programme.time.speed;
    time.at = share(*programme.time.pulse);
    if (programme.time.in) time.in = share(static_cast<double>(*programme.time.in));
    if (programme.time.out) time.out = share(static_cast<double>(*programme.time.out));
    time.loops = programme.time.loops;
    return time;
}

std::optional<PanelTake> panel_take(const TakeState& take) {
    if (take.phase == TakePhase::none && take.failure.empty()) return std::nullopt;
    PanelTake panel;
    panel.is_running = take.phase == TakePhase::opening || take.phase == TakePhase::recording;
    panel.path = take.path;
    panel.duration_s = take.duration_s;
    panel.mb_s = take.mb_s;
    for (const TakeState::Rig& rig : take.rigs) panel.left_out += rig.dropped + rig.refused;
    panel.failure = take.failure;
    return panel;
}

PanelOutput panel_output(const OutputState& output) {
    constexpr double bits_a_megabit = 1e6;
    return {output.name,
            words_of(output.phase),
            output.phase == OutputPhase::on,
            output.phase == OutputPhase::failed,
            output.bit_rate_bps / bits_a_megabit,
            output.queued,
            output.dropped,
            output.failure};
}

}  // namespace

PanelRig PanelFeed::rig_of(const RigAccount& account, const FrameSet* set) const {
    const RigStatus& status = account.status;
    PanelRig rig;
    rig.name = status.rig;
    rig.state = state_in(set, status);
    if (const auto rate = rig_rates_.find(status.rig); rate != rig_rates_.end())
        rig.rate_hz = rate->second.per_second();
    rig.latency_ms = status.latency_ms.p50;
    rig.lost = status.rig_counters.missed + status.rig_counters.late + status.link.send_dropped +
               status.lost + status.undecodable + status.late + status.duplicate +
               status.unsynchronized + status.out_of_step + status.queue_dropped;
    rig.worries = worries_of(status);
    if (account.set) {
        rig.set_known = account.set->known;
        if (!account.set->misfit.empty()) rig.worries.push_back(account.set->misfit);
    }
    if (const auto picture = disparities_.find(status.rig); picture != disparities_.end())
        rig.disparity = &picture->second;
    return rig;
}

void PanelFeed::refresh_disparities(const FrameSet& set) {
    for (const FrameSet::Slot& slot : set.slots) {
        if (!slot.frame || slot.frame->disparity.empty()) continue;
        const ColourImage picture = disparity_picture(*slot.frame);
        const auto old = disparities_.find(slot.rig);
        if (old != disparities_.end() && old->second.size() != picture.size())
            disparities_.erase(old);
        disparities_.try_emplace(slot.rig, TextureFormat::rgba8, picture.cols, picture.rows)
            .first->second.upload(picture);
    }
}

std::optional<PanelNovelty> PanelFeed::novelty_of(const ProgrammeState& programme) {
    if (!programme.source_map) return std::nullopt;
    PanelNovelty novelty;
    if (!programme.picture || !programme.picture->sources) {
        novelty.remark = fmt::format("The synthesiser {} cannot tell.", programme.synthesiser);
        return novelty;
    }
    const SourceMap& map = *programme.picture->sources;
    for (const NoveltyOverlay::Key& key : map.legend) {
        const auto share = map.shares.rigs.find(key.rig);
        novelty.rows.push_back({key.rig,
                                {key.colour[0], key.colour[1], key.colour[2]},
                                share == map.shares.rigs.end() ? 0.0 : share->second});
    }
    const auto* filled = novelty_filled_colour;
    novelty.rows.push_back({"filled", {filled[0], filled[1], filled[2]}, map.shares.filled});
    const auto* known = novelty_remembered_colour;
    novelty.rows.push_back({"remembered", {known[0], known[1], known[2]}, map.shares.remembered});
    return novelty;
}

void PanelFeed::refresh(LiveShow& show, const ProgrammeState& programme, const FrameSet* set,
                        MonotonicTime now) {
    const LiveReport report = show.report();
    picture_rate_.add(report.programme.pictures, now);
    for (const RigAccount& rig : report.rigs)
        rig_rates_[rig.status.rig].add(rig.status.received, now);
    if (set) refresh_disparities(*set);

    state_.rigs.clear();
    for (const RigAccount& rig : report.rigs) state_.rigs.push_back(rig_of(rig, set));
    state_.stages.clear();
    for (const StepTime& step : step_times(report))
        state_.stages.push_back({step.name, step.ms.p50, is_at_rig(step.name)});
    state_.picture_rate_hz = picture_rate_.per_second();
    state_.latency_ms = programme.latency_ms;
    state_.signal = report.signal;
    state_.novelty = novelty_of(programme);
    state_.outputs.clear();
    state_.recording = false;
    for (const OutputState& output : report.outputs) {
        state_.outputs.push_back(panel_output(output));
        if (!output.film.empty() && output.phase == OutputPhase::on) state_.recording = true;
    }
}

PanelState PanelFeed::state(LiveShow& show, const std::optional<TakeState>& take,
                            const std::string& question) {
    const MonotonicTime now = MonotonicClock::now();
    const ProgrammeState programme = show.state();
    if (!timecodes_)
        timecodes_.emplace(show.settings().pulse_rate_hz, show.settings().pulse_rate_hz);
    if (renderer_.empty()) renderer_ = GlInfo::query().renderer;
    if (programme.latency_ms > 0 && programme.latency_ms != last_latency_ms_) {
        last_latency_ms_ = programme.latency_ms;
        latencies_ms_.push_back(static_cast<float>(programme.latency_ms));
        if (latencies_ms_.size() > latency_samples) latencies_ms_.pop_front();
    }
    const FrameSet* set = programme.picture ? programme.picture->job.instant->set.get() : nullptr;
    if (!refreshed_ || now - *refreshed_ >= refresh_period) {
        refreshed_ = now;
        refresh(show, programme, set, now);
    }
    if (programme.picture && programme.picture != uploaded_) {
        uploaded_ = programme.picture;
        const ColourImage& shown =
            uploaded_->sources ? uploaded_->sources->picture : uploaded_->picture;
        if (!picture_ || picture_->size() != shown.size())
            picture_.emplace(TextureFormat::rgba8, shown.cols, shown.rows, Filter::linear);
        picture_->upload(shown);
    }
    state_.picture = picture_ ? &*picture_ : nullptr;
    state_.waiting = set == nullptr;
    if (set) {
        state_.pulse = set->trigger_index;
        state_.timecode = timecodes_->of(*set);
    }
    state_.question = question;
    state_.take = take ? panel_take(*take) : std::nullopt;
    state_.behind_s = programme.behind_s;
    state_.time = panel_time(programme);
    state_.latency_history_ms.assign(latencies_ms_.begin(), latencies_ms_.end());
    state_.synthesiser = programme.synthesiser;
    state_.render_level = programme.render_level;
    state_.prepare_level = programme.prepare_level;
    state_.renderer = renderer_;
    state_.view = programme.view;
    const FlightControls::Lines lines = show.controls().lines();
    state_.move_progress = lines.move_progress;
    state_.wheel = lines.wheel;
    state_.coverage = lines.corridor.now;
    return state_;
}

}  // namespace vantage
