#include "host_app/programme/programme.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "common/base/log.h"
#include "common/base/this_thread.h"
#include "common/base/time/time.h"
#include "common/base/trace/trace.h"
#include "host_app/programme/reprojection.h"
#include "host_app/programme/tick_clock.h"

namespace vantage {
namespace {

/// Period at which a tick checks whether the renderer has become idle.
constexpr std::chrono::milliseconds poll_period{2};
/// Longest time that the first tick waits for the warm-up, and then for a newer instant.
constexpr std::chrono::seconds max_warm_up{20}, max_wait_for_instant{1};
/// Time without a change of camera and instant after which the best frame is rendered.
constexpr std::chrono::milliseconds idle_before_best{250};
/// Way of the camera, as a share of the picture's width, up to which a reprojection counts as good
/// as a long frame.
constexpr double reprojection_tolerance = 0.02;

void sleep_until(MonotonicTime time) { std::this_thread::sleep_for(time - MonotonicClock::now()); }

std::string title_of(const MadePicture& made, double time_s) {
    constexpr double deg = 180 / std::numbers::pi;
    const FrameSet& frame_set = *made.job.instant->set;
    const Eigen::Vector3d& at = made.job.camera.world_from_camera.translation();
    return fmt::format(
        "{:.1f} s   pulse {}   {} of {} rigs   camera at {:.1f}, {:.1f}, {:.1f} m, {:.0f} degrees "
        "wide",
        time_s, frame_set.trigger_index, frame_set.present(), frame_set.slots.size(), at.x(),
        at.y(), at.z(), made.job.camera.field_of_view_rad * deg);
}

}  // namespace

Programme::Programme(Settings settings, InstantThread& instants, CameraSource& camera_source)
    : settings_(std::move(settings)),
      instants_(instants),
      camera_source_(camera_source),
      governor_(settings_.rate_hz, settings_.pulse_rate_hz, settings_.quality),
      replay_(settings_.replay),
      timing_(settings_.rate_hz, MonotonicClock::now()),
      synthesisers_(settings_.format, instants_, find_synthesiser(settings_.synthesiser)),
      still_(settings_.format, instants_),
      preview_(settings_.format, settings_.rate_hz, instants_.contexts(),
               instants_.render_priority()),
      reprojector_({settings_.format.width_px, settings_.format.height_px}),
      sound_(settings_.sound, settings_.rate_hz, settings_.pulse_rate_hz),
      source_map_(settings_.source_map) {
    // The first instant is prepared for the view from which the camera starts.
    camera_.view = camera_source_.step(0, transport().pulse()).view;
    camera_.now = camera_.view.camera();
    camera_.forecast.see(camera_.now, 0);
    request_instant(MonotonicClock::now());
    const SynthesiserEntry& first = synthesisers_.synthesiser();
    instants_.prepare_for(first.name, first.make_preparer);
    state_.view = camera_.view;
    state_.synthesiser = first.name;
}

Programme::~Programme() {
    is_stopping_ = true;
    if (thread_.joinable()) thread_.join();
}

void Programme::start(std::function<bool(std::uint64_t, double)> is_over) {
    is_over_ = std::move(is_over);
    thread_ = std::thread([this] {
        name_this_thread("programme");
        try {
            run();
        } catch (...) {
            const std::lock_guard lock(mutex_);
            failure_ = std::current_exception();
        }
        const std::lock_guard lock(mutex_);
        is_ended_ = true;
    });
}

bool Programme::is_over() const {
    const std::lock_guard lock(mutex_);
    if (failure_) std::rethrow_exception(failure_);
    return is_ended_;
}

void Programme::stop() {
    is_stopping_ = true;
    if (thread_.joinable()) thread_.join();
    synthesisers_.end();
    still_.end();
    preview_.end();
    sinks_.finish();
}

void Programme::warm_up() {
    const std::shared_ptr<const ReadyInstant> instant = instants_.newest();
    if (!synthesisers_.fits(instant.get())) return;
    PictureMaker& maker = synthesisers_.maker();
    const MonotonicTime end = MonotonicClock::now() + max_warm_up;
    const auto is_idle_in_time = [&] {
        while (!maker.is_idle()) {
            if (is_stopping_ || MonotonicClock::now() > end) return false;
            std::this_thread::sleep_for(poll_period);
        }
        return true;
    };
    if (!is_idle_in_time()) return;
    maker.warm_up({instant, camera_.now, governor_.render(), source_map_});
    if (!is_idle_in_time() || !instant->is_live) return;
    // The first frame is to show a newer instant than the one of the warm-up.
    const MonotonicTime timeout = MonotonicClock::now() + max_wait_for_instant;
    while (!is_stopping_ && instants_.newest() == instant && MonotonicClock::now() < timeout)
        std::this_thread::sleep_for(poll_period);
}

void Programme::run() {
    warm_up();
    const MonotonicTime start = MonotonicClock::now();
    TickClock clock(settings_.rate_hz, start);
    std::uint64_t tick = clock.next_tick(start);
    while (!is_stopping_) {
        const MonotonicTime due = start + clock.time_of(tick + 1);
        const double due_s = std::chrono::duration<double>(clock.time_of(tick + 1)).count();
        sleep_until(due - lead());
        TraceSpan tick_span("tick");
        tick_span.with("late_us", (MonotonicClock::now() - (due - lead())).count() / 1000);
        const bool was_due = take_step(due_s, MonotonicClock::now());
        const MonotonicTime reproject_at = due - reprojection_lead();
        bool is_begun = false, is_reprojecting = false;
        for (;;) {
            const MonotonicTime now = MonotonicClock::now();
            if (!is_begun && synthesisers_.maker().is_idle() &&
                (take_sought_instant() ||
                 (was_due && is_worth_rendering() && has_picture_time(now)))) {
                begin_picture();
                is_begun = true;
            }
            refine_held_instant(now);
            if (now >= due) break;
            if (now >= reproject_at && !std::exchange(is_reprojecting, true)) begin_reprojection();
            const bool is_done = is_begun || !(was_due || seek_.is_on());
            const MonotonicTime next = is_reprojecting ? due : reproject_at;
            sleep_until(is_done ? next : std::min(next, now + poll_period));
        }
        follow_synthesiser();
        const std::uint64_t next = clock.next_tick(MonotonicClock::now());
        hand_over(next - tick, was_due, due);
        follow_preview();
        tick = next;
        if (is_over_(recorder_.ticks(), due_s)) return;
        if (settings_.ends_with_past && transport().is_at_end() && frames_.shown &&
            past_pulse() == frames_.shown->job.instant->set->trigger_index)
            return;
    }
}

void Programme::take_time(CameraStep& step, double time_s,
                          const std::optional<PastFrameSets::Span>& span) {
    // Playback starts with the first frame.
    if (frames_.shown && last_step_s_)
        replay_.advance(time_s - *last_step_s_, settings_.pulse_rate_hz, span);
    last_step_s_ = time_s;
    if (instant_) replay_.take(step.time, instant_->set->trigger_index, span);
    if (const std::optional<int> shot = replay_.take_shot()) {
        const CameraStep flown = camera_source_.fly_to_shot(*shot);
        step.view = flown.view;
        step.camera = flown.camera;
    }
    // A position that stands keeps its moments between two pulses, unless a jump led there.
    if (transport().state().speed != 0)
        moments_a_pulse_ = governor_.moments_a_pulse(transport().state().speed);
    else if (seek_.has_jumped(transport().jumps()))
        moments_a_pulse_ = 1;
}

bool Programme::take_step(double time_s, MonotonicTime now) {
    TraceSpan sampling("camera sample");
    CameraStep step = camera_source_.step(time_s, transport().pulse());
    ++step_;
    sampling.in(TraceId::of_step(step_), TraceFlow::begins);
    if (step.input) sampling.in(TraceId::of_input(*step.input), TraceFlow::passes);
    instant_ = instants_.newest();
    const std::optional<PastFrameSets::Span> span = instants_.past_span();
    take_time(step, time_s, span);
    const CameraState camera = step.camera.value_or(step.view.camera());
    const bool flies = !is_same_view(camera, camera_.now);
    // Input before the first frame waits for the start, and the time of a jump is measured on its
    // own. Marks and the preview's camera change no frame of the programme.
    if (step.input && frames_.shown && !seek_.has_jumped(transport().jumps()) &&
        (flies || step.toggle_source_map))
        input_latency_.saw(*step.input, step_, !step.toggle_source_map);
    seek_.follow(transport().jumps(), past_pulse(),
                 frames_.shown ? std::optional(frames_.shown->job.instant->set->trigger_index)
                               : std::nullopt,
                 now);
    // After a jump the first frame of its target comes before all others.
    still_.pause(seek_.is_on());
    preview_.pause(seek_.is_on());
    if (step.toggle_source_map) source_map_ = !source_map_;
    if (step.next_synthesiser) synthesisers_.begin_next();
    if (flies || step.time.moves_time() || transport().is_moving()) changed_ = now;
    camera_.view = step.view;
    camera_.before = std::exchange(camera_.now, camera);
    camera_.preview = step.preview;
    camera_.forecast.see(camera_.now, time_s);
    request_instant(now);
    update_state(span, now);
    const bool is_due = is_picture_due();
    // Input that changes no frame has no latency.
    if (!is_due) input_latency_.drop();
    return is_due;
}

void Programme::update_state(const std::optional<PastFrameSets::Span>& span, MonotonicTime now) {
    recorder_.set_level_shares(governor_.render_shares(now), governor_.prepare_shares(now));
    const std::lock_guard lock(mutex_);
    state_.view = camera_.view;
    state_.preview.view = camera_.preview;
    state_.time = transport().state();
    state_.replay = replay_.state();
    state_.past = span;
    state_.source_map = source_map_;
    state_.behind_s.reset();
    if (transport().pulse() && span && !transport().is_of_take())
        state_.behind_s = std::max(
            0.0, (as_pulse(span->newest) - *transport().pulse()) / settings_.pulse_rate_hz);
}

PictureJob Programme::wanted_picture() const {
    return {instant_, camera_.now, governor_.render(), source_map_, step_};
}

bool Programme::is_picture_due() const {
    if (!synthesisers_.fits(instant_.get())) return false;
    const std::shared_ptr<const MadePicture>& shown = frames_.shown;
    const PictureJob job = wanted_picture();
    if (shown && shown->job.level.rank < job.level.rank) {
        PictureJob at_better_level = job;
        at_better_level.level = shown->job.level;
        if (is_same_picture(at_better_level, shown->job)) return false;
    }
    return !shown || !is_same_picture(job, shown->job);
}

bool Programme::is_worth_rendering() {
    const PictureJob job = wanted_picture();
    take_finished();
    if (frames_.rendered && is_same_picture(frames_.rendered->job, job)) return false;
    if (!transport().is_moving() || !begun_ || !are_pictures_long()) return true;
    PictureJob again = *begun_;
    again.camera = camera_.now;
    return camera_.is_still() || !is_same_picture(again, job) ||
           Reprojection::way(begun_->camera, camera_.forecast.in(timing_.usual_ms() / 1000)) >
               reprojection_tolerance;
}

bool Programme::has_picture_time(MonotonicTime now) {
    const bool has_budget = timing_.has_budget(governor_.rendering_budget(), now);
    return has_budget || !transport().is_moving() || is_input_waiting_for_rendering();
}

bool Programme::is_input_waiting_for_rendering() const {
    if (!input_latency_.is_waiting() || !frames_.shown) return false;
    return input_latency_.is_waiting_for_rendering() ||
           Reprojection::way(frames_.newest_rendered()->job.camera, camera_.now) >
               Reprojection::max_way;
}

std::optional<std::uint64_t> Programme::past_pulse() const {
    return transport().pulse() ? instants_.past_pulse_at(*transport().pulse()) : std::nullopt;
}

bool Programme::take_sought_instant() {
    if (!seek_.is_on()) return false;
    std::shared_ptr<const ReadyInstant> newest = instants_.newest();
    if (newest == instant_ || !synthesisers_.fits(newest.get())) return false;
    instant_ = std::move(newest);
    return true;
}

double Programme::shown_in_s() const {
    if (!instant_) return 0;
    const double prepare_s = instant_->prepare_ms / 1000;
    return prepare_s + 0.5 * std::max(prepare_s, 1 / settings_.pulse_rate_hz);
}

void Programme::request_instant(MonotonicTime now) {
    const bool is_idle = !transport().is_moving() && now - changed_ > idle_before_best;
    const PrepareLevel& level = seek_.is_on()                         ? governor_.prepare_sought()
                                : is_idle && !settings_.quality.level ? prepare_levels().front()
                                                                      : governor_.prepare();
    const cv::Size size(settings_.format.width_px, settings_.format.height_px);
    instants_.request(
        {transport().pulse(), moments_a_pulse_, transport().is_held(),
         view_of(camera_.forecast.in(shown_in_s()), size), level, transport().jumps(),
         camera_.preview ? std::optional(view_of(camera_.preview->camera(), size)) : std::nullopt});
    if (!instant_ || instant_->number == noted_instant_ || !transport().is_moving()) return;
    noted_instant_ = instant_->number;
    governor_.saw_prepare(instant_->instant->level, instant_->prepare_ms, now);
    if (!instant_->is_live) governor_.saw_past_instant(instant_->fetch_ms + instant_->prepare_ms);
}

void Programme::begin_picture() {
    begun_ = wanted_picture();
    // Ticks show a long frame reprojected, and by less if it is rendered for their camera.
    if (are_pictures_long() && !camera_.is_still())
        begun_->camera = camera_.forecast.in(timing_.usual_ms() / 1000 + 1 / settings_.rate_hz);
    synthesisers_.maker().start(*begun_);
}

void Programme::take_finished() {
    if (std::shared_ptr<const MadePicture> fresh = synthesisers_.maker().take_finished()) {
        if (frames_.rendered) recorder_.count_replaced_frame();
        frames_.rendered = std::move(fresh);
    }
    if (std::shared_ptr<const MadePicture> reprojected = reprojector_.take_finished())
        frames_.reprojected = std::move(reprojected);
}

void Programme::begin_reprojection() {
    take_finished();
    std::shared_ptr<const MadePicture> newest = frames_.newest_rendered();
    if (!newest || is_same_view(newest->job.camera, camera_.now) || !reprojector_.is_idle()) return;
    // After a cut to the preview its frame is the one to start from.
    if (const std::shared_ptr<const MadePicture> preview = preview_.picture();
        preview && Reprojection::way(newest->job.camera, camera_.now) > Reprojection::max_way &&
        Reprojection::way(preview->job.camera, camera_.now) <= Reprojection::max_way)
        newest = preview;
    reprojector_.start(std::move(newest), camera_.now, step_);
}

std::shared_ptr<const MadePicture> Programme::take_reprojection() {
    std::shared_ptr<const MadePicture> reprojected = std::exchange(frames_.reprojected, nullptr);
    const std::uint64_t known = std::max(frames_.rendered ? frames_.rendered->job.step : 0,
                                         frames_.handed ? frames_.handed->job.step : 0);
    if (!reprojected || reprojected->job.step <= known) return nullptr;
    // A frame that was rendered meanwhile waits for the next tick, unless it has the present
    // camera.
    if (is_same_view(frames_.newest_rendered()->job.camera, camera_.now)) return nullptr;
    return reprojected;
}

void Programme::refine_held_instant(MonotonicTime now) {
    if (settings_.quality.level || transport().is_moving() || now - changed_ < idle_before_best ||
        !instant_ || !frames_.shown || frames_.shown->job.level.rank == 0 ||
        instant_->instant->level > 0)
        return;
    still_.refine(synthesisers_.synthesiser(),
                  {instant_, camera_.now, render_levels().front(), source_map_});
}

void Programme::follow_preview() {
    preview_.follow(camera_.preview, synthesisers_.synthesiser(), instant_,
                    synthesisers_.maker().is_idle() && !seek_.is_on(), MonotonicClock::now());
    recorder_.record_preview(preview_.pictures(), preview_.last_make_ms());
    const std::lock_guard lock(mutex_);
    state_.preview.picture = preview_.picture();
    state_.preview.pictures = preview_.pictures();
}

void Programme::follow_synthesiser() {
    if (!synthesisers_.follow(instant_.get())) return;
    const std::lock_guard lock(mutex_);
    state_.synthesiser = synthesisers_.synthesiser().name;
}

void Programme::note(const MadePicture& made, MonotonicTime now) {
    timing_.add(made.make_ms);
    governor_.saw_render(made.job.level, made.render_ms + made.readback_ms,
                         !made.inverse_depth.empty(), now);
    sound_.note_delay(*made.job.instant, transport());
    if (!seek_.is_on()) return;
    const std::optional<std::uint64_t> stands_at = past_pulse();
    const std::lock_guard lock(mutex_);
    seek_.saw(*made.job.instant, stands_at, now);
}

void Programme::take_still(MonotonicTime now) {
    std::shared_ptr<const MadePicture> still = still_.take_finished();
    if (!still || transport().is_moving() || !is_same_view(still->job.camera, camera_.now) ||
        still->job.instant != instant_)
        return;
    note_rest(*still, now);
    frames_.shown = std::move(still);
}

void Programme::note_rest(const MadePicture& made, MonotonicTime now) {
    const bool is_best = made.job.level.rank == 0 && made.job.instant->instant->level == 0;
    if (!is_best || transport().is_moving() || rest_noted_ == changed_) return;
    rest_noted_ = changed_;
    recorder_.record_rest(to_ms(now - changed_));
}

void Programme::hand_over(std::uint64_t passed_ticks, bool was_due, MonotonicTime due) {
    TraceSpan span("hand over");
    const MonotonicTime now = MonotonicClock::now();
    span.with("late_us", (now - due).count() / 1000);
    take_finished();
    const std::shared_ptr<const MadePicture> reprojected = take_reprojection();
    const bool is_new =
        frames_.rendered && (!reprojected || reprojected->rendered == frames_.rendered);
    if (is_new) {
        // Ticks before the first frame do not count: the newest of those that passed is the first.
        if (!frames_.shown && passed_ticks > 1) {
            due += from_s(static_cast<double>(passed_ticks - 1) / settings_.rate_hz);
            passed_ticks = 1;
        }
        note(*frames_.rendered, now);
        frames_.shown = frames_.handed = std::exchange(frames_.rendered, nullptr);
        note_rest(*frames_.shown, now);
    }
    if (reprojected) {
        frames_.handed = reprojected;
    } else if (!is_new) {
        take_still(now);
        if (frames_.shown && is_same_view(frames_.shown->job.camera, camera_.now))
            frames_.handed = frames_.shown;
    }
    if (!frames_.handed) return;
    if (is_new || reprojected)
        span.in(TraceId::of_step(frames_.handed->job.step), TraceFlow::ends)
            .in(TraceId::of_frame_set(frames_.handed->job.instant->set->trigger_index),
                TraceFlow::ends);
    span.in(TraceId::of_tick(sink_ticks_), TraceFlow::begins);
    const std::optional<double> latency_ms =
        recorder_.record({.fresh = is_new ? frames_.shown.get() : nullptr,
                          .reprojected = reprojected.get(),
                          .was_due = was_due,
                          .passed_ticks = passed_ticks,
                          .due = due,
                          .now = now,
                          .faults = synthesisers_.faults()});
    std::optional<MonotonicTime> input;
    {
        const std::lock_guard lock(mutex_);
        state_.picture = frames_.handed;
        if (latency_ms) state_.latency_ms = *latency_ms;
        if (reprojected || is_new)
            input = input_latency_.showed(
                frames_.handed->job.step,
                reprojected ? reprojected->rendered->job.step : frames_.shown->job.step, now);
    }
    if (input) span.in(TraceId::of_input(*input), TraceFlow::ends);
    give_to_sinks(*frames_.handed, passed_ticks, due);
}

void Programme::give_to_sinks(const MadePicture& shown, std::uint64_t ticks, MonotonicTime due) {
    for (std::uint64_t i = 0; i < ticks; ++i, ++sink_ticks_) {
        const ProgrammePicture picture{
            sink_ticks_,
            due + from_s(static_cast<double>(i) / settings_.rate_hz),
            shown.picture,
            shown.sources ? shown.sources->picture : shown.picture,
            shown.job.instant->set,
            shown.job.camera,
            title_of(shown, static_cast<double>(sink_ticks_) / settings_.rate_hz),
            sound_.next(due, i, transport())};
        sinks_.give(picture);
    }
}

ProgrammeState Programme::state() const {
    const std::lock_guard lock(mutex_);
    return state_;
}

ProgrammeStats Programme::stats() const {
    ProgrammeStats stats = recorder_.stats();
    stats.sinks = sinks_.states();
    const std::lock_guard lock(mutex_);
    stats.input_ms = input_latency_.all_ms();
    stats.seek_ms = seek_.all_ms();
    stats.seek_steps_ms = seek_.steps_ms();
    return stats;
}

}  // namespace vantage
