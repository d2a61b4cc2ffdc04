#include "host_app/session/live_show.h"

#include <algorithm>
#include <cmath>

#include "common/base/counted.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/time/pulse_grid.h"
#include "common/gl/context/limits.h"
#include "host_app/output/contact_sheet.h"
#include "host_app/views/depth_view.h"

namespace vantage {
namespace {

/// How long the framing of the stage waits for missing rigs: rigs of one stage start together.
constexpr std::chrono::seconds framing_patience{3};
/// Period of the log lines about missing rigs.
constexpr std::chrono::seconds waiting_report_period{10};

/// Lists the states of the rigs that are not in the frame set, or of all rigs without one.
std::string states_of_missing(const ReceiverStatus& status, const FrameSet* set) {
    std::string text;
    for (const RigStatus& rig : status.rigs) {
        if (set &&
            std::any_of(set->slots.begin(), set->slots.end(), [&](const FrameSet::Slot& slot) {
                return slot.frame && slot.rig == rig.rig;
            }))
            continue;
        text += fmt::format("{}{} {}", text.empty() ? "" : "; ", rig.rig, full_state_of(rig));
    }
    return text;
}

/// Lists the rigs that report a start-up step, with that step.
std::string starts_of(const ReceiverStatus& status) {
    std::string text;
    for (const RigStatus& rig : status.rigs)
        if (rig.connected && !rig.health.starting.empty())
            text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", rig.rig, rig.health.starting);
    return text;
}

double seconds_of(std::chrono::nanoseconds time) {
    return std::chrono::duration<double>(time).count();
}

double field_of_view_rad(const RigFrame& frame) {
    return 2 * std::atan(0.5 * frame.geometry.width_px / frame.geometry.f_px);
}

void name_assumed_places(const FrameSet& set) {
    for (const FrameSet::Slot& slot : set.slots)
        if (slot.frame && slot.frame->place_is_assumed)
            log_warning(
                "rig {} has no stage calibration; it is assumed to be level and {:.1f} m above the "
                "floor; run vantage-calib stage to measure its position",
                slot.rig, slot.frame->world_from_camera.translation().y());
}

Percentiles worst(const ReceiverStatus& status, Percentiles RigStatus::*times) {
    Percentiles slowest;
    for (const RigStatus& rig : status.rigs)
        if ((rig.*times).count > 0 && (rig.*times).p95 >= slowest.p95) slowest = rig.*times;
    return slowest;
}

std::string checked_renderer(ContextGroup& contexts) {
    const ContextGroup::Member member = contexts.join();
    const CurrentContext current(*member.context);
    const GlInfo info = GlInfo::query();
    info.require_vantage_minimum();
    return info.renderer;
}

/// Returns the first pulse of a take.
std::optional<double> begin_of(const PastFrameSets* take) {
    if (!take) return std::nullopt;
    const std::optional<PastFrameSets::Span> span = take->span();
    return span ? std::optional(static_cast<double>(span->oldest)) : std::nullopt;
}

const LiveSettings& checked(const LiveSettings& settings) {
    const SynthesiserEntry entry = find_synthesiser(settings.synthesiser);
    if (settings.source_map) SourceMapOverlay::require(entry.tells_origins, entry.name);
    if (settings.format.stereoscopy)
        (void)settings.format.stereoscopy->settled(
            view_of(CameraState{}, {settings.format.width_px, settings.format.height_px}), 1);
    return settings;
}

}  // namespace

OutputSupervisor::Settings output_settings(const LiveSettings& settings) {
    return {.format = {.width_px = settings.format.width_px,
                       .height_px = settings.format.height_px,
                       .rate_hz = settings.rate_hz,
                       .encoder = settings.encoder,
                       .overwrites = settings.overwrites,
                       .has_sound = settings.sound != nullptr},
            .pulse_rate_hz = settings.pulse_rate_hz,
            .urls = settings.outputs};
}

LiveShow::LiveShow(const LiveSettings& settings, const FlightPlan& plan, StageFeed feed,
                   JogDevices* deck)
    : settings_(checked(settings)),
      plan_(plan),
      renderer_(checked_renderer(contexts_)),
      instants_({.pulse_rate_hz = settings.pulse_rate_hz,
                 .replay_bytes = settings.replay_bytes,
                 .compensate_gains = settings.compensate_gains,
                 .colours = settings.colours,
                 .take = settings.take,
                 .background = settings.background},
                std::move(feed), contexts_),
      stage_corridor_(static_cast<double>(settings.format.height_px) / settings.format.width_px),
      controls_(
          {plan, settings.pulse_rate_hz, settings.replay_bytes > 0 || settings.take,
           settings.free_flight, begin_of(settings.take.get())},
          deck, [this](int number) { return rig_view(number); }, [this] { return framing(); },
          [this] { return corridor_now(); }),
      outputs_(output_settings(settings)),
      programme_({.format = settings.format,
                  .rate_hz = settings.rate_hz,
                  .pulse_rate_hz = settings.pulse_rate_hz,
                  .synthesiser = settings.synthesiser,
                  .quality = settings.quality,
                  .source_map = settings.source_map,
                  .replay = settings.replay,
                  .ends_with_past = settings.ends_with_take,
                  .sound = settings.sound},
                 instants_, controls_) {
    programme_.add(outputs_.sink());
    if (!settings.contact_sheet.empty())
        programme_.add(std::make_unique<ContactSheetSink>(settings.contact_sheet));
}

bool LiveShow::wait_for_rigs(std::chrono::nanoseconds limit, StopSignal& stop,
                             const std::function<void()>& while_waiting,
                             std::chrono::nanoseconds start_limit) {
    const MonotonicTime begin = MonotonicClock::now(), latest = begin + limit + start_limit;
    MonotonicTime deadline = begin + limit;
    bool told_of_start = false;
    const auto newest_frame_set = [&]() -> const FrameSet* {
        const std::shared_ptr<const ReadyInstant> ready = instants_.newest();
        return ready ? ready->set.get() : nullptr;
    };
    log_info("waiting for the first frames of {}", counted(status().rigs.size(), "rig"));
    MonotonicTime reported = MonotonicClock::now();
    while (MonotonicClock::now() < deadline) {
        if (stop.wait_for(std::chrono::milliseconds(20))) {
            log_info("interrupted while waiting for the rigs, before the first picture: {}",
                     states_of_missing(status(), newest_frame_set()));
            return false;
        }
        const std::shared_ptr<const ReadyInstant> ready = instants_.newest();
        if (ready && ready->set->present() == static_cast<int>(ready->set->slots.size()))
            return true;
        if (while_waiting) while_waiting();
        const ReceiverStatus now = status();
        if (!now.rigs.empty() &&
            std::all_of(now.rigs.begin(), now.rigs.end(),
                        [](const RigStatus& rig) { return !rig.refused.empty(); }))
            fail("every rig refuses this host: {}", states_of_missing(now, newest_frame_set()));
        if (const std::string starts = starts_of(now); !starts.empty()) {
            if (!told_of_start && MonotonicClock::now() - begin >= limit) {
                told_of_start = true;
                log_info("waiting on, up to {:g} s, because rigs are starting: {}",
                         seconds_of(latest - begin), starts);
            }
            deadline = std::min(MonotonicClock::now() + limit, latest);
        }
        if (MonotonicClock::now() - reported >= waiting_report_period) {
            log_info("still waiting for frames: {}", states_of_missing(now, newest_frame_set()));
            reported = MonotonicClock::now();
        }
    }
    const double limit_s = std::round(10 * seconds_of(deadline - begin)) / 10;
    if (!instants_.newest())
        fail("no rig sent a frame within {:g} s; check that the rigs are running ({})", limit_s,
             states_of_missing(status(), nullptr));
    log_warning("continuing without rigs that sent no frame within {:g} s: {}", limit_s,
                states_of_missing(status(), newest_frame_set()));
    return true;
}

bool LiveShow::wait_for_first_frame_set(StopSignal& stop) {
    while (!instants_.newest())
        if (stop.wait_for(std::chrono::milliseconds(5))) return false;
    return true;
}

void LiveShow::start() {
    programme_.start(
        [this](std::uint64_t pictures, double time_s) { return plan_.is_over(pictures, time_s); });
}

void LiveShow::finish() {
    // Ending the outputs takes time, in which the signal may change.
    last_signal_ = signal();
    programme_.stop();
    outputs_.finish();
    last_status_ = instants_.close();
}

std::optional<StageFraming> LiveShow::framing() {
    const std::shared_ptr<const ReadyInstant> ready = instants_.newest();
    if (!ready) return std::nullopt;
    const MonotonicTime now = MonotonicClock::now();
    if (!framing_since_) framing_since_ = now;
    if (ready->set->present() < static_cast<int>(ready->set->slots.size()) &&
        now - *framing_since_ < framing_patience)
        return std::nullopt;
    std::vector<FramedRig> rigs;
    for (const FrameSet::Slot& slot : ready->set->slots) {
        if (!slot.frame) continue;
        const RigFrame& frame = *slot.frame;
        rigs.push_back({frame.rig, frame.world_from_camera, field_of_view_rad(frame),
                        surface_samples(depth_view_of(frame)).median_depth_m});
    }
    std::optional<StageFraming> framing = frame_stage(rigs);
    // This happens once: the framing is not requested again.
    if (framing) {
        name_assumed_places(*ready->set);
        stage_corridor_.begin(framing->extent);
    }
    return framing;
}

std::shared_ptr<const Corridor> LiveShow::corridor_now() {
    if (const std::shared_ptr<const ReadyInstant> ready = instants_.newest();
        ready && (ready->is_live || settings_.take))
        stage_corridor_.update(*ready->set);
    return stage_corridor_.now();
}

std::optional<OrbitView> LiveShow::rig_view(int number) const {
    const std::shared_ptr<const ReadyInstant> ready = instants_.newest();
    const auto index = static_cast<std::size_t>(number - 1);
    if (!ready || index >= ready->set->slots.size() || !ready->set->slots[index].frame)
        return std::nullopt;
    const RigFrame& frame = *ready->set->slots[index].frame;
    // The pivot is the point on the rig's axis that is nearest to the camera's pivot.
    const Eigen::Vector3d eye = frame.world_from_camera.translation();
    const Eigen::Vector3d axis = frame.world_from_camera.linear().col(2);
    const double distance_m = std::max(0.5, axis.dot(state().view.pivot_m - eye));
    return view_from_eye(eye, eye + distance_m * axis, field_of_view_rad(frame));
}

SignalState LiveShow::signal_of(const ReceiverStatus& status, const ProgrammeState& state) const {
    return signal_state(status, state.time.is_held || state.time.pulse,
                        PulseGrid(settings_.pulse_rate_hz).period(), MonotonicClock::now());
}

LiveReport LiveShow::report() const {
    const ReceiverStatus status = last_status_.value_or(this->status());
    const InstantThread::Stats instants = instants_.stats();
    LiveReport report;
    report.format = settings_.format;
    report.rate_hz = settings_.rate_hz;
    report.programme = programme_.stats();
    const ProgrammeState state = programme_.state();
    report.synthesiser = state.synthesiser;
    report.view = state.view;
    report.renderer = renderer_;
    report.signal = last_signal_.value_or(signal_of(status, state));
    report.time = state.time;
    report.replay = state.replay;
    report.past = state.past;
    report.pulse_rate_hz = settings_.pulse_rate_hz;
    if (state.picture) report.shown_pulse = state.picture->job.instant->set->trigger_index;
    report.corridor = controls_.lines().corridor;
    report.free_flight = settings_.free_flight;
    report.instants_prepared = instants.prepared;
    report.instants_between = instants.between;
    report.prepare_ms = instants.prepare_ms;
    report.rig_steps = instants.rig_steps;
    report.faults = instants.faults + report.programme.faults;
    report.contexts_lost = contexts_.losses();
    report.frame_sets_closed = status.sets;
    report.frame_sets_complete = status.complete_frame_sets;
    report.frame_sets_dropped = status.frame_sets_dropped;
    report.frame_sets_replaced = instants.replaced.sets;
    const auto count_of = [](const RigCounts& counts, const std::string& rig) {
        const auto found = counts.find(rig);
        return found == counts.end() ? 0 : found->second;
    };
    for (const RigStatus& rig : status.rigs) {
        RigAccount account{rig, count_of(instants.frames, rig.rig),
                           count_of(instants.replaced.frames, rig.rig)};
        if (const auto gain_compensation = instants.gain_compensation.find(rig.rig);
            gain_compensation != instants.gain_compensation.end())
            account.gain_compensation = gain_compensation->second;
        for (const RigBackgroundState& background : instants.backgrounds)
            if (background.rig == rig.rig) account.background = background;
        report.rigs.push_back(std::move(account));
    }
    report.network_ms = worst(status, &RigStatus::network_ms);
    report.decode_ms = worst(status, &RigStatus::decode_ms);
    if (state.picture) {
        if (settings_.format.stereoscopy)
            report.stereoscopy = settings_.format.stereoscopy->settled(
                view_of(state.picture->job.camera,
                        {settings_.format.width_px, settings_.format.height_px}),
                state.picture->job.camera.focus_m);
        if (state.picture->sources) report.source_map = state.picture->sources->shares;
    }
    report.reloads = reloads_;
    if (settings_.sound) report.sound = settings_.sound->state();
    report.outputs = outputs_.states();
    for (const OutputState& output : report.outputs)
        if (output.write_ms.count > 0 && output.write_ms.p95 >= report.encode_ms.p95)
            report.encode_ms = output.write_ms;
    return report;
}

}  // namespace vantage
