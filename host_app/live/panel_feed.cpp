#include "host_app/live/panel_feed.h"

#include <algorithm>

#include <fmt/format.h>

#include "common/gl/limits.h"
#include "host_app/live/disparity_picture.h"
#include "host_app/live/live_report.h"

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

}  // namespace

PanelRig PanelFeed::rig_of(const RigStatus& status, const FrameSet* set) const {
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

std::optional<PanelNovelty> PanelFeed::novelty_of(const LiveSession& session) {
    if (!session.novelty()) return std::nullopt;
    PanelNovelty novelty;
    const std::optional<NoveltyShares> shares = session.last_shares();
    if (!shares) {
        novelty.remark = fmt::format("The synthesiser {} cannot tell.", session.synthesiser());
        return novelty;
    }
    for (const NoveltyOverlay::Key& key : session.novelty_legend()) {
        const auto share = shares->rigs.find(key.rig);
        novelty.rows.push_back({key.rig,
                                {key.colour[0], key.colour[1], key.colour[2]},
                                share == shares->rigs.end() ? 0.0 : share->second});
    }
    const auto* filled = novelty_filled_colour;
    novelty.rows.push_back({"filled", {filled[0], filled[1], filled[2]}, shares->filled});
    const auto* known = novelty_remembered_colour;
    novelty.rows.push_back({"remembered", {known[0], known[1], known[2]}, shares->remembered});
    return novelty;
}

void PanelFeed::refresh(LiveSession& session, std::uint64_t pictures, MonotonicTime now) {
    picture_rate_.add(pictures, now);
    const ReceiverStatus& status = session.refresh_status();
    for (const RigStatus& rig : status.rigs) rig_rates_[rig.rig].add(rig.received, now);
    if (session.shown()) refresh_disparities(*session.shown());

    state_.rigs.clear();
    for (const RigStatus& rig : status.rigs) state_.rigs.push_back(rig_of(rig, session.shown()));
    state_.stages.clear();
    for (const StageTime& time : session.stage_summary()) {
        if (time.ms.count == 0) continue;
        const bool at_rig =
            time.stage == stage_name(Stage::capture) || time.stage == stage_name(Stage::rectify) ||
            time.stage == stage_name(Stage::match) || time.stage == stage_name(Stage::pack);
        state_.stages.push_back({time.stage, time.ms.p50, at_rig});
    }
    state_.picture_rate_hz = picture_rate_.per_second();
    state_.latency_ms = session.latest_latency_ms();
    state_.novelty = novelty_of(session);
}

PanelState PanelFeed::state(LiveSession& session, const Texture& picture, const OrbitView& view,
                            const FlightControls& controls, std::uint64_t pictures) {
    const MonotonicTime now = MonotonicClock::now();
    if (renderer_.empty()) renderer_ = GlInfo::query().renderer;
    if (session.sets_shown() != last_set_ && session.latest_latency_ms() > 0) {
        last_set_ = session.sets_shown();
        latencies_ms_.push_back(static_cast<float>(session.latest_latency_ms()));
        if (latencies_ms_.size() > latency_samples) latencies_ms_.pop_front();
    }
    if (!refreshed_ || now - *refreshed_ >= refresh_period) {
        refreshed_ = now;
        refresh(session, pictures, now);
    }
    state_.picture = &picture;
    state_.waiting = session.shown() == nullptr;
    if (const FrameSet* set = session.shown()) {
        state_.pulse = set->trigger_index;
        for (const FrameSet::Slot& slot : set->slots)
            if (slot.frame) state_.timecode = slot.frame->timecode;
    }
    state_.frozen = session.frozen();
    state_.behind_s = session.behind_s();
    state_.recording = session.recording();
    state_.latency_history_ms.assign(latencies_ms_.begin(), latencies_ms_.end());
    state_.synthesiser = session.synthesiser();
    state_.renderer = renderer_;
    state_.view = view;
    state_.move_progress = controls.move_progress();
    state_.wheel = controls.wheel_line();
    return state_;
}

}  // namespace vantage
