#include "host_app/desk/feed/desk_feed.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "common/base/memory_pressure.h"
#include "common/gl/context/limits.h"
#include "host_app/desk/desk_arrangement.h"
#include "host_app/desk/feed/desk_values.h"
#include "host_app/desk/feed/stage_map.h"
#include "host_app/session/report/live_report.h"

namespace vantage {
namespace {

/// Period of the numbers and the rigs' pictures: faster changes could not be read.
constexpr std::chrono::milliseconds refresh_period{250};
constexpr std::size_t latency_samples = 240;
/// Length of the camera's path in the plan, and the smallest step that adds a point to it.
constexpr std::chrono::seconds path_length{10};
constexpr double min_path_step_m = 0.02;
/// Segments of the planned move's line.
constexpr int move_steps = 96;
/// How long a notice of replay is shown.
constexpr std::chrono::seconds notice_duration{5};
/// How long the result of a reload of the stage file is shown: it may be a long sentence.
constexpr std::chrono::seconds reload_notice_duration{12};
/// Radius of the corridor's map, in distances of the farthest rig from the pivot.
constexpr double corridor_reach = 1.3;

std::string reload_notice(const StageReloads& reloads, MonotonicTime now) {
    const bool is_shown = !reloads.sentence.empty() && now - reloads.when < reload_notice_duration;
    return is_shown ? reloads.sentence : "";
}

bool is_at_rig(const std::string& step) {
    return step == "capture" || step == "rectify" || step == "match" || step == "pack";
}

std::optional<DeskTime> desk_time(const LiveShow& show, const ProgrammeState& programme,
                                  const std::optional<TakeState>& take) {
    if (!programme.past) return std::nullopt;
    DeskTime time;
    time.oldest = static_cast<double>(programme.past->oldest);
    time.newest = static_cast<double>(programme.past->newest);
    time.rate_hz = show.settings().pulse_rate_hz;
    time.is_of_take = show.settings().take != nullptr;
    time.at = programme.time.pulse;
    time.speed = programme.time.speed;
    if (programme.time.in) time.in = static_cast<double>(*programme.time.in);
    if (programme.time.out) time.out = static_cast<double>(*programme.time.out);
    time.loops = programme.time.loops;
    if (take && take->phase == TakePhase::recording) time.recorded_s = take->duration_s;
    const std::shared_ptr<const Move> move = time.is_of_take ? show.controls().move() : nullptr;
    if (move && move->take_s_at(0))
        for (const MoveKeyframe& keyframe : move->keyframes())
            time.keyframes.push_back(time.oldest + *keyframe.take_s * time.rate_hz);
    return time;
}

std::optional<DeskTake> desk_take(const TakeState& take) {
    if (take.phase == TakePhase::none && take.failure.empty()) return std::nullopt;
    DeskTake desk;
    desk.is_running = take.phase == TakePhase::opening || take.phase == TakePhase::recording;
    desk.path = std::filesystem::path(take.path).filename().string();
    desk.duration_s = take.duration_s;
    desk.mb_s = take.mb_s;
    for (const TakeState::Rig& rig : take.rigs) desk.left_out += rig.dropped + rig.refused;
    desk.failure = take.failure;
    desk.trouble = take.trouble;
    return desk;
}

DeskSound desk_sound(const SoundState& sound) {
    constexpr std::uint64_t samples_a_ms = sound_rate_hz / 1000;
    return {sound.name,      key_of(sound.phase),          sound.phase == SoundPhase::on,
            sound.peak_dbfs, sound.missing / samples_a_ms, sound.failure};
}

DeskOutput desk_output(const OutputState& output) {
    constexpr double bits_a_megabit = 1e6;
    // The panel has no room for a film's folder.
    return {output.film.empty()
                ? output.name
                : fmt::format("film {}", std::filesystem::path(output.film).filename().string()),
            words_of(output.phase),
            output.phase == OutputPhase::on,
            output.phase == OutputPhase::failed,
            output.bit_rate_bps / bits_a_megabit,
            output.queued,
            output.dropped,
            output.failure};
}

DeskPlan::Rig plan_rig(const StagePlaces::Rig& rig) {
    return {rig.name,
            rig.rig.world_from_camera.translation(),
            rig.rig.world_from_camera.linear().col(2),
            rig.rig.half_width,
            rig.rig.half_height,
            rig.is_away};
}

}  // namespace

DeskRig DeskFeed::rig_of(const RigAccount& account, const FrameSet* set, MonotonicTime now) {
    const RigStatus& status = account.status;
    DeskRig rig;
    rig.name = status.rig;
    rig.state = state_in(set, status);
    if (const auto rate = rig_rates_.find(status.rig); rate != rig_rates_.end())
        rig.rate_hz = rate->second.per_second();
    const auto seen = rigs_seen_.try_emplace(status.rig, now).first;
    if (rig.state == RigState::present) seen->second = now;
    rig.absent_s = std::chrono::duration<double>(now - seen->second).count();
    rig.latency_ms = status.latency_ms.p50;
    rig.lost_at_rig = status.rig_counters.missed + status.rig_counters.late;
    rig.lost_on_the_way = status.link.send_dropped + status.lost;
    rig.lost_at_host = status.undecodable + status.late + status.duplicate + status.unsynchronized +
                       status.out_of_step + status.queue_dropped;
    if (const RigPictures::Pictures* pictures = rig_pictures_.of(status.rig)) {
        if (pictures->colour) rig.colour = &*pictures->colour;
        if (pictures->depth) rig.depth = &*pictures->depth;
        if (pictures->mask) rig.mask = &*pictures->mask;
        rig.nearest_m = pictures->range.nearest_m;
        rig.farthest_m = pictures->range.farthest_m;
    }
    if (status.health.temperature_c) rig.temperature_c = *status.health.temperature_c;
    rig.clock = short_clock_words(status);
    rig.calibration = calibration_words(status.health, std::chrono::system_clock::now());
    rig.worries = worries_of(status);
    if (account.background) {
        rig.background_known = account.background->known;
        if (!account.background->misfit.empty()) rig.worries.push_back(account.background->misfit);
    }
    return rig;
}

std::optional<DeskSources> DeskFeed::sources_of(const ProgrammeState& programme) {
    if (!programme.source_map) return std::nullopt;
    DeskSources sources;
    if (!programme.picture || !programme.picture->sources) {
        sources.remark =
            fmt::format("The synthesiser {} has no source map.", programme.synthesiser);
        return sources;
    }
    const SourceMap& map = *programme.picture->sources;
    for (const SourceMapOverlay::Key& key : map.legend) {
        const auto share = map.shares.rigs.find(key.rig);
        sources.rows.push_back({key.rig,
                                {key.colour[0], key.colour[1], key.colour[2]},
                                share == map.shares.rigs.end() ? 0.0 : share->second});
    }
    const auto* filled = source_map_inpainted_colour;
    sources.rows.push_back({"inpainted", {filled[0], filled[1], filled[2]}, map.shares.filled});
    const auto* known = source_map_remembered_colour;
    sources.rows.push_back({"background", {known[0], known[1], known[2]}, map.shares.remembered});
    return sources;
}

void DeskFeed::refresh(LiveShow& show, const ProgrammeState& programme, const FrameSet* set,
                       MonotonicTime now) {
    const LiveReport report = show.report();
    picture_rate_.add(report.programme.pictures, now);
    repeat_rate_.add(report.programme.repeated, now);
    preview_rate_.add(programme.preview.pictures, now);
    for (const RigAccount& rig : report.rigs)
        rig_rates_[rig.status.rig].add(rig.status.received, now);
    if (set) rig_pictures_.take(*set);
    for (const RigAccount& rig : report.rigs)
        if (rig.background) rig_pictures_.take_mask(rig.status.rig, rig.background->matte);

    state_.rigs.clear();
    for (const RigAccount& rig : report.rigs)
        if (!rig.status.is_removed) state_.rigs.push_back(rig_of(rig, set, now));
    state_.computer_worry = memory_worry(memory_pressure());
    if (!show.settings().take) {
        const auto date = std::chrono::system_clock::now();
        state_.synchronisation = sync_words(show.settings().sync_proof, date);
        state_.is_sync_doubtful = is_doubtful(show.settings().sync_proof, date);
    }
    state_.steps.clear();
    for (const StepTime& step : step_times(report))
        state_.steps.push_back({step.name, step.ms.p50, is_at_rig(step.name)});
    state_.figures = desk_figures(report);
    state_.has_frame_sets = show.settings().take || report.frame_sets_closed > 0;
    state_.picture_rate_hz = picture_rate_.per_second();
    state_.tick_rate_hz = show.settings().rate_hz;
    state_.repeat_rate_hz = repeat_rate_.per_second();
    state_.repeated = report.programme.repeated;
    state_.age_s = live_age_s(programme);
    state_.signal = report.signal;
    // A picture that is not live has no latency.
    const bool is_live = report.signal == SignalState::live;
    state_.latency_ms = latencies_ms_.empty() || !is_live ? 0 : latencies_ms_.back();
    state_.latencies_ms.assign(latencies_ms_.begin(), latencies_ms_.end());
    state_.sources = sources_of(programme);
    state_.sound = report.sound ? std::optional(desk_sound(*report.sound)) : std::nullopt;
    state_.outputs.clear();
    state_.recording = false;
    for (const OutputState& output : report.outputs) {
        state_.outputs.push_back(desk_output(output));
        if (!output.film.empty() && output.phase == OutputPhase::on) state_.recording = true;
    }
}

void DeskFeed::follow_move(const LiveShow& show) {
    const std::shared_ptr<const Move> move = show.controls().move();
    if (move == move_) return;
    move_ = move;
    state_.move.reset();
    move_m_.clear();
    keyframes_m_.clear();
    if (!move_) return;
    for (int i = 0; i <= move_steps; ++i)
        move_m_.push_back(move_->at(move_->duration_s() * i / move_steps).eye_m());
    state_.move = DeskMove{move_->duration_s(), {}};
    for (const MoveKeyframe& keyframe : move_->keyframes()) {
        keyframes_m_.push_back(keyframe.view.eye_m());
        state_.move->keyframes.push_back(
            move_->duration_s() > 0 ? keyframe.time_s / move_->duration_s() : 0);
    }
}

void DeskFeed::follow_plan(const LiveShow& show, const ProgrammeState& programme,
                           MonotonicTime now) {
    const Eigen::Vector3d eye_m = programme.view.eye_m();
    while (!path_.empty() && now - path_.front().time > path_length) path_.pop_front();
    if (path_.empty() || (path_.back().eye_m - eye_m).norm() > min_path_step_m)
        path_.push_back({now, eye_m});
    const std::optional<StagePlaces> places = show.places();
    if (!places) return;
    DeskPlan plan;
    double reach_m = programme.view.distance_m;
    for (const StagePlaces::Rig& rig : places->rigs) {
        plan.rigs.push_back(plan_rig(rig));
        reach_m = std::max(reach_m, (plan.rigs.back().eye_m - programme.view.pivot_m).norm());
    }
    plan.extent = places->extent;
    corridor_.follow(show.corridor(), programme.view, corridor_reach * reach_m);
    plan.corridor = corridor_.fields();
    plan.corridor_pivot_m = corridor_.pivot_m();
    plan.corridor_elevation_rad = corridor_.elevation_rad();
    plan.points = points_;
    for (const Placed& placed : path_) plan.path_m.push_back(placed.eye_m);
    follow_move(show);
    plan.move_m = move_m_;
    plan.keyframes_m = keyframes_m_;
    state_.plan = std::move(plan);
}

void DeskFeed::follow_points(const ProgrammeState& programme, bool are_wanted) {
    const std::shared_ptr<const FrameSet> set =
        are_wanted && programme.picture ? programme.picture->job.instant->set : nullptr;
    if (set == points_of_) return;
    points_of_ = set;
    points_ = set ? stage_points(*set) : std::vector<DeskPlan::Point>();
}

void DeskFeed::follow_shots(const LiveShow& show, const ProgrammeState& programme,
                            MonotonicTime now) {
    const FlightControls::Shots kept = show.controls().shots();
    if (programme.picture) shot_pictures_.follow(kept, *programme.picture, now);
    state_.shots.clear();
    for (std::size_t number = 1; number <= shot_places; ++number) {
        DeskShot shot;
        if (const std::optional<Shot>& own = kept[number - 1]) {
            const bool is_named = own->name != fmt::format("shot {}", number);
            shot = {is_named ? own->name : "stored", shot_pictures_.of(number), true};
        } else if (number <= state_.rigs.size()) {
            const DeskRig& rig = state_.rigs[number - 1];
            shot = {rig.name, rig.colour, false};
        }
        state_.shots.push_back(std::move(shot));
    }
}

void DeskFeed::follow_replay(const ProgrammeState& programme, const FrameSet* set,
                             MonotonicTime now) {
    const ReplayState& replay = programme.replay;
    if (programme.picture && replay.book)
        clip_pictures_.follow(*replay.book, *programme.picture, now);
    state_.replay =
        desk_replay(programme, clip_pictures_, set ? tai_offset_s_of(*set).value_or(0) : 0);
    if (std::exchange(notices_, replay.notices) != replay.notices) noticed_ = now;
    state_.notice = notices_ > 0 && now - noticed_ < notice_duration ? replay.notice : "";
}

void DeskFeed::follow_preview(const FlightControls::Lines& lines, const ProgrammeState& programme) {
    state_.preview.reset();
    if (!lines.preview) return;
    DeskPreview shown;
    shown.picture = preview(programme);
    shown.view = lines.preview->view;
    shown.picture_rate_hz = preview_rate_.per_second();
    shown.is_near_only =
        programme.preview.picture && programme.preview.picture->job.instant->instant->level > 0;
    shown.coverage = lines.preview->coverage;
    shown.fly_progress = lines.preview->fly_progress;
    shown.programme_move = lines.preview->move_progress;
    shown.fly_s = lines.fly_to_preview_s;
    state_.preview = shown;
}

void DeskFeed::note_shown(const ProgrammeState& programme) {
    if (!programme.picture) return;
    const ReadyInstant& instant = *programme.picture->job.instant;
    if (!instant.is_live || !instant.exposure || instant.set->trigger_index == latency_of_) return;
    latency_of_ = instant.set->trigger_index;
    latencies_ms_.push_back(
        std::chrono::duration<float, std::milli>(TaiClock::now() - *instant.exposure).count());
    if (latencies_ms_.size() > latency_samples) latencies_ms_.pop_front();
}

DeskState DeskFeed::state(LiveShow& show, const ProgrammeState& programme,
                          const std::optional<TakeState>& take, const std::string& question,
                          bool wants_points) {
    const MonotonicTime now = MonotonicClock::now();
    if (!timecodes_)
        timecodes_.emplace(show.settings().pulse_rate_hz, show.settings().pulse_rate_hz);
    if (renderer_.empty()) renderer_ = GlInfo::query().renderer;
    const FrameSet* set = programme.picture ? programme.picture->job.instant->set.get() : nullptr;
    if (!refreshed_ || now - *refreshed_ >= refresh_period) {
        refreshed_ = now;
        refresh(show, programme, set, now);
        follow_points(programme, wants_points);
    }
    state_.picture = picture(programme);
    state_.waiting = set == nullptr;
    if (set) {
        state_.pulse = set->trigger_index;
        state_.timecode = timecodes_->of(*set);
    }
    state_.question = question.empty() ? programme.replay.question : question;
    follow_replay(programme, set, now);
    if (state_.notice.empty()) state_.notice = reload_notice(show.reloads(), now);
    state_.take = take ? desk_take(*take) : std::nullopt;
    state_.behind_s = programme.behind_s;
    state_.time = desk_time(show, programme, take);
    state_.synthesiser = programme.synthesiser;
    state_.render_level = programme.render_level();
    state_.prepare_level = programme.prepare_level();
    state_.renderer = renderer_;
    state_.view = programme.view;
    const FlightControls::Lines lines = show.controls().lines();
    state_.recording_flight = lines.is_recording;
    state_.follows_performer = lines.is_following;
    state_.holds_horizon = lines.holds_horizon;
    state_.move_progress = lines.move_progress;
    state_.wheel = lines.wheel;
    state_.wheel_map = desk_wheel(show.controls().wheels().view(now));
    state_.has_unsaved_wheel = !show.controls().wheels().unsaved().empty();
    // Without a signal there is no coverage.
    const bool is_covered = state_.signal != SignalState::no_signal;
    state_.coverage = is_covered ? lines.corridor.now : std::nullopt;
    follow_preview(lines, programme);
    if (state_.preview && !is_covered) state_.preview->coverage.reset();
    follow_plan(show, programme, now);
    follow_shots(show, programme, now);
    return state_;
}

const Texture* ShownPicture::follow(const std::shared_ptr<const MadePicture>& newest) {
    if (newest == uploaded_) return uploaded_ ? &*texture_ : nullptr;
    uploaded_ = newest;
    if (!uploaded_) return nullptr;
    const ColourImage& shown =
        uploaded_->sources ? uploaded_->sources->picture : uploaded_->picture;
    if (!texture_ || texture_->size() != shown.size())
        texture_.emplace(TextureFormat::rgba8, shown.cols, shown.rows, Filter::linear);
    texture_->upload(shown);
    return &*texture_;
}

}  // namespace vantage
