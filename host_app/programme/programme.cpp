#include "host_app/programme/programme.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "common/base/log.h"
#include "common/base/this_thread.h"
#include "common/base/time/pulse_grid.h"
#include "common/base/time/time.h"
#include "host_app/programme/tick_clock.h"

namespace vantage {
namespace {

/// How often a tick looks whether the picture maker has become free.
constexpr std::chrono::milliseconds look_period{2};
/// For which the first tick waits.
constexpr std::chrono::seconds max_warm_up{20}, rest_of_warm_up{1};
/// A camera and an instant that were left alone for so long are worth the best picture.
constexpr std::chrono::milliseconds rest{250};
/// Pictures that the lead before a tick is judged by, fewest and most, and what is added to the
/// longest of them.
constexpr std::size_t fewest_judged = 20, judged_pictures = 200;
constexpr double lead_ratio = 1.3, lead_margin_ms = 3;
/// Pictures that take more than this share of a tick leave instants too little time: they are not
/// made of what a reprojection by no more than this share of a picture's width will show as well.
constexpr double short_picture = 0.5, near_enough = 0.02;
/// Of the time for pictures, at most, while instants have to be prepared beside them.
constexpr double most_for_pictures = 0.75;
constexpr std::chrono::milliseconds longest_carried{200};

double ms_between(MonotonicTime start, MonotonicTime end) { return to_ms(end - start); }

void sleep_until(MonotonicTime time) { std::this_thread::sleep_for(time - MonotonicClock::now()); }

std::string title_of(const MadePicture& made, double time_s) {
    constexpr double deg = 180 / std::numbers::pi;
    const FrameSet& set = *made.job.instant->set;
    const Eigen::Vector3d& at = made.job.camera.world_from_camera.translation();
    return fmt::format(
        "{:.1f} s   pulse {}   {} of {} rigs   camera at {:.1f}, {:.1f}, {:.1f} m, {:.0f} degrees "
        "wide",
        time_s, set.trigger_index, set.present(), set.slots.size(), at.x(), at.y(), at.z(),
        made.job.camera.field_of_view_rad * deg);
}

}  // namespace

Programme::Programme(Settings settings, InstantThread& instants, CameraSource& camera_source)
    : settings_(std::move(settings)),
      instants_(instants),
      camera_source_(camera_source),
      governor_(settings_.rate_hz, settings_.pulse_rate_hz, settings_.quality),
      replay_(settings_.replay),
      preview_(settings_.format, settings_.rate_hz, instants_.contexts(),
               instants_.render_priority()),
      reprojector_({settings_.format.width_px, settings_.format.height_px}),
      source_map_(settings_.source_map),
      picture_time_(most_for_pictures, longest_carried, MonotonicClock::now()) {
    // The first instant is prepared for where the camera begins.
    view_ = camera_source_.step(0, transport().pulse()).view;
    camera_ = view_.camera();
    forecast_.see(camera_, 0);
    request_instant(MonotonicClock::now());
    renderer_ = &renderer_of(find_synthesiser(settings_.synthesiser));
    const SynthesiserEntry& first = renderer_->synthesiser;
    instants_.prepare_for(first.name, first.make_preparer);
    state_.view = view_;
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
    renderers_.clear();
    preview_.end();
    sinks_.finish();
}

bool Programme::can_reproject() const { return shown_ && !shown_->inverse_depth.empty(); }

double Programme::usual_make_ms() const {
    if (make_ms_.size() < fewest_judged) return 0;
    std::vector<double> ms(make_ms_.begin(), make_ms_.end());
    const auto middle = ms.begin() + static_cast<std::ptrdiff_t>(ms.size() / 2);
    std::nth_element(ms.begin(), middle, ms.end());
    return *middle;
}

bool Programme::are_pictures_long() const {
    return can_reproject() && usual_make_ms() >= short_picture * 1000 / settings_.rate_hz;
}

std::chrono::nanoseconds Programme::lead() const {
    const double period_ms = 1000 / settings_.rate_hz;
    if (make_ms_.size() < fewest_judged) return from_s(period_ms / 1000);
    // Where hardly any is ready at its tick, ticks show reprojections, and looks may be late.
    if (can_reproject() && usual_make_ms() > period_ms) return reprojection_lead();
    const double longest_ms = *std::max_element(make_ms_.begin(), make_ms_.end());
    return from_s(std::min(lead_ratio * longest_ms + lead_margin_ms, period_ms) / 1000);
}

std::chrono::nanoseconds Programme::reprojection_lead() const {
    const double lead_ms = lead_ratio * reprojector_.longest_ms() + lead_margin_ms;
    return from_s(std::min(lead_ms / 1000, 1 / settings_.rate_hz));
}

void Programme::warm_up() {
    const std::shared_ptr<const ReadyInstant> instant = instants_.newest();
    if (!instant || instant->synthesiser != renderer_->synthesiser.name) return;
    const MonotonicTime end = MonotonicClock::now() + max_warm_up;
    const auto is_idle_in_time = [&] {
        while (!renderer_->maker->is_idle()) {
            if (is_stopping_ || MonotonicClock::now() > end) return false;
            std::this_thread::sleep_for(look_period);
        }
        return true;
    };
    if (!is_idle_in_time()) return;
    renderer_->maker->warm_up({instant, camera_, governor_.render(), source_map_});
    if (!is_idle_in_time() || !instant->is_live) return;
    // The first picture is to be of now.
    const MonotonicTime patience = MonotonicClock::now() + rest_of_warm_up;
    while (!is_stopping_ && instants_.newest() == instant && MonotonicClock::now() < patience)
        std::this_thread::sleep_for(look_period);
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
        const bool was_due = look(due_s, MonotonicClock::now());
        const MonotonicTime carry = due - reprojection_lead();
        bool is_begun = false, is_carried = false;
        for (;;) {
            const MonotonicTime now = MonotonicClock::now();
            if (!is_begun && renderer_->maker->is_idle() &&
                (take_up_sought() || (was_due && is_worth_rendering() && has_picture_time(now)))) {
                begin_picture();
                is_begun = true;
            }
            refine_held_instant(now);
            if (now >= due) break;
            if (now >= carry && !std::exchange(is_carried, true)) begin_reprojection();
            const bool is_done = is_begun || !(was_due || seek_.is_on());
            const MonotonicTime next = is_carried ? due : carry;
            sleep_until(is_done ? next : std::min(next, now + look_period));
        }
        follow_synthesiser();
        const std::uint64_t next = clock.next_tick(MonotonicClock::now());
        hand_over(next - tick, was_due, due);
        follow_preview();
        tick = next;
        const std::lock_guard lock(mutex_);
        if (is_over_(stats_.ticks, due_s)) return;
        if (settings_.ends_with_past && transport().is_at_end() && shown_ &&
            instants_.past_pulse_at(*transport().pulse()) ==
                shown_->job.instant->set->trigger_index)
            return;
    }
}

bool Programme::look(double time_s, MonotonicTime now) {
    CameraStep step = camera_source_.step(time_s, transport().pulse());
    ++look_;
    instant_ = instants_.newest();
    const std::optional<PastFrameSets::Span> span = instants_.past_span();
    // Time begins with the first picture.
    if (shown_ && last_look_s_)
        replay_.advance(time_s - *last_look_s_, settings_.pulse_rate_hz, span);
    last_look_s_ = time_s;
    if (instant_) replay_.take(step.time, instant_->set->trigger_index, span);
    if (const std::optional<int> shot = replay_.take_shot()) {
        const CameraStep flown = camera_source_.fly_to_shot(*shot);
        step.view = flown.view;
        step.camera = flown.camera;
    }
    // Where time stands, it stands between two pulses if it came there slowly, and not by a jump.
    if (transport().state().speed != 0)
        moments_a_pulse_ = governor_.moments_a_pulse(transport().state().speed);
    else if (seek_.has_jumped(transport().jumps()))
        moments_a_pulse_ = 1;
    const CameraState camera = step.camera.value_or(step.view.camera());
    const bool flies = !is_same_view(camera, camera_);
    // Whoever moves before the first picture waits for the start, and a jump's time is counted by
    // its own name. What only marks, or flies the preview, waits for no picture of the programme.
    if (step.hand && shown_ && !seek_.has_jumped(transport().jumps()) &&
        (flies || step.toggle_source_map))
        operator_input_.saw(*step.hand, look_, !step.toggle_source_map);
    seek_.follow(transport().jumps(), past_pulse(),
                 shown_ ? std::optional(shown_->job.instant->set->trigger_index) : std::nullopt,
                 now);
    // What is held was left: its better picture waits for the first one of where time jumped to.
    if (renderer_->still) renderer_->still->pause(seek_.is_on());
    preview_.pause(seek_.is_on());
    if (step.toggle_source_map) source_map_ = !source_map_;
    if (step.next_synthesiser && !next_) begin_next_synthesiser();
    if (flies || step.time.is_any() || transport().is_moving()) changed_ = now;
    view_ = step.view;
    camera_before_ = std::exchange(camera_, camera);
    preview_view_ = step.preview;
    forecast_.see(camera_, time_s);
    request_instant(now);
    {
        const std::lock_guard lock(mutex_);
        state_.view = view_;
        state_.preview.view = preview_view_;
        state_.time = transport().state();
        state_.replay = replay_.state();
        state_.past = span;
        state_.source_map = source_map_;
        state_.behind_s = transport().pulse() && span && !transport().is_of_take()
                              ? std::optional(std::max(0.0, (static_cast<double>(span->newest) -
                                                             *transport().pulse()) /
                                                                settings_.pulse_rate_hz))
                              : std::nullopt;
        stats_.render_shares = governor_.render_shares(now);
        stats_.prepare_shares = governor_.prepare_shares(now);
    }
    const bool is_due = is_picture_due();
    // An input that changes no picture waits for none.
    if (!is_due) operator_input_.drop();
    return is_due;
}

PictureJob Programme::wanted_picture() const {
    return {instant_, camera_, governor_.render(), source_map_, look_};
}

bool Programme::is_picture_due() const {
    if (!instant_ || instant_->synthesiser != renderer_->synthesiser.name) return false;
    const PictureJob job = wanted_picture();
    if (shown_ && shown_->job.level.rank < job.level.rank) {
        PictureJob better = job;
        better.level = shown_->job.level;
        if (is_same_picture(better, shown_->job)) return false;
    }
    return !shown_ || !is_same_picture(job, shown_->job);
}

bool Programme::is_worth_rendering() {
    const PictureJob job = wanted_picture();
    take_finished();
    if (rendered_ && is_same_picture(rendered_->job, job)) return false;
    if (!transport().is_moving() || !begun_ || !are_pictures_long()) return true;
    PictureJob again = *begun_;
    again.camera = camera_;
    return is_same_view(camera_, camera_before_) || !is_same_picture(again, job) ||
           Reprojection::way(begun_->camera, forecast_.in(usual_make_ms() / 1000)) > near_enough;
}

bool Programme::has_picture_time(MonotonicTime now) {
    const bool has_some = picture_time_.has_some(now);
    return has_some || !transport().is_moving() || is_input_waiting_for_rendering();
}

bool Programme::is_input_waiting_for_rendering() const {
    if (!operator_input_.is_waiting() || !shown_) return false;
    return operator_input_.is_waiting_for_rendering() ||
           Reprojection::way(newest_rendered()->job.camera, camera_) > Reprojection::furthest;
}

std::optional<std::uint64_t> Programme::past_pulse() const {
    return transport().pulse() ? instants_.past_pulse_at(*transport().pulse()) : std::nullopt;
}

bool Programme::take_up_sought() {
    if (!seek_.is_on()) return false;
    std::shared_ptr<const ReadyInstant> newest = instants_.newest();
    if (!newest || newest->synthesiser != renderer_->synthesiser.name || newest == instant_)
        return false;
    instant_ = std::move(newest);
    return true;
}

double Programme::shown_in_s() const {
    if (!instant_) return 0;
    const double prepare_s = instant_->prepare_ms / 1000;
    return prepare_s + 0.5 * std::max(prepare_s, 1 / settings_.pulse_rate_hz);
}

void Programme::request_instant(MonotonicTime now) {
    const bool is_resting = !transport().is_moving() && now - changed_ > rest;
    const PrepareLevel& level = seek_.is_on() ? governor_.prepare_sought()
                                : is_resting && !settings_.quality.level ? prepare_levels().front()
                                                                         : governor_.prepare();
    const cv::Size size(settings_.format.width_px, settings_.format.height_px);
    instants_.request(
        {transport().pulse(), moments_a_pulse_, transport().is_held(),
         view_of(forecast_.in(shown_in_s()), size), level, transport().jumps(),
         preview_view_ ? std::optional(view_of(preview_view_->camera(), size)) : std::nullopt});
    if (instant_ && instant_->number != seen_prepared_ && transport().is_moving()) {
        seen_prepared_ = instant_->number;
        governor_.saw_prepare(instant_->instant->level, instant_->prepare_ms, now);
        if (!instant_->is_live)
            governor_.saw_past_instant(instant_->fetch_ms + instant_->prepare_ms);
    }
}

void Programme::begin_picture() {
    begun_ = wanted_picture();
    // The ticks that show it reproject it: by less where it is of the camera that they will have.
    if (are_pictures_long() && !is_same_view(camera_, camera_before_))
        begun_->camera = forecast_.in(usual_make_ms() / 1000 + 1 / settings_.rate_hz);
    renderer_->maker->start(*begun_);
}

void Programme::take_finished() {
    if (std::shared_ptr<const MadePicture> fresh = renderer_->maker->take_finished()) {
        if (rendered_) {
            const std::lock_guard lock(mutex_);
            ++stats_.superseded;
        }
        rendered_ = std::move(fresh);
    }
    if (std::shared_ptr<const MadePicture> carried = reprojector_.take_finished())
        carried_ = std::move(carried);
}

void Programme::begin_reprojection() {
    take_finished();
    std::shared_ptr<const MadePicture> newest = newest_rendered();
    if (!newest || is_same_view(newest->job.camera, camera_) || !reprojector_.is_idle()) return;
    // A cut to the preview is there already.
    if (const std::shared_ptr<const MadePicture> preview = preview_.picture();
        preview && Reprojection::way(newest->job.camera, camera_) > Reprojection::furthest &&
        Reprojection::way(preview->job.camera, camera_) <= Reprojection::furthest)
        newest = preview;
    reprojector_.start(std::move(newest), camera_, look_);
}

std::shared_ptr<const MadePicture> Programme::newest_carried() {
    std::shared_ptr<const MadePicture> carried = std::exchange(carried_, nullptr);
    const std::uint64_t known =
        std::max(rendered_ ? rendered_->job.look : 0, handed_ ? handed_->job.look : 0);
    if (!carried || carried->job.look <= known) return nullptr;
    // One that was rendered after the reprojection of the one before was begun waits for the next
    // tick, but if it is of the camera as it is.
    if (is_same_view(newest_rendered()->job.camera, camera_)) return nullptr;
    return carried;
}

void Programme::refine_held_instant(MonotonicTime now) {
    if (settings_.quality.level || transport().is_moving() || now - changed_ < rest || !instant_ ||
        !shown_ || shown_->job.level.rank == 0 || instant_->instant->level > 0)
        return;
    std::unique_ptr<PictureMaker>& still = renderer_->still;
    if (!still) {
        still = std::make_unique<PictureMaker>(renderer_->synthesiser, settings_.format,
                                               instants_.contexts(), instants_.render_priority(),
                                               PictureMaker::Manner::in_slices);
        return;
    }
    const PictureJob job{instant_, camera_, render_levels().front(), source_map_};
    if (!still->is_idle() || (begun_still_ && is_same_picture(*begun_still_, job))) return;
    begun_still_ = job;
    still->start(job);
}

Programme::Renderer& Programme::renderer_of(const SynthesiserEntry& synthesiser) {
    Renderer& renderer = renderers_[synthesiser.name];
    if (!renderer.maker) {
        renderer.synthesiser = synthesiser;
        renderer.maker = std::make_unique<PictureMaker>(
            synthesiser, settings_.format, instants_.contexts(), instants_.render_priority());
    }
    return renderer;
}

void Programme::begin_next_synthesiser() {
    const std::vector<SynthesiserEntry> all = synthesiser_entries();
    const auto at = std::find_if(all.begin(), all.end(), [&](const SynthesiserEntry& entry) {
        return entry.name == renderer_->synthesiser.name;
    });
    next_ = &renderer_of(at == all.end() || at + 1 == all.end() ? all.front() : *(at + 1));
}

void Programme::follow_preview() {
    const MonotonicTime now = MonotonicClock::now();
    preview_.follow(preview_view_, renderer_->synthesiser, instant_,
                    renderer_->maker->is_idle() && !seek_.is_on(), now);
    const std::lock_guard lock(mutex_);
    state_.preview.picture = preview_.picture();
    if (stats_.preview_pictures != preview_.pictures()) preview_ms_.add(preview_.last_make_ms());
    stats_.preview_pictures = state_.preview.pictures = preview_.pictures();
}

void Programme::follow_synthesiser() {
    if (!next_ || !next_->maker->is_idle()) return;
    const SynthesiserEntry& wanted = next_->synthesiser;
    instants_.prepare_for(wanted.name, wanted.make_preparer);
    if (!instant_ || instant_->synthesiser != wanted.name) return;
    if (renderer_->still) renderer_->still->pause(false);
    begun_still_.reset();
    renderer_ = std::exchange(next_, nullptr);
    (void)renderer_->maker->take_finished();  // of when it was last in use
    const std::lock_guard lock(mutex_);
    state_.synthesiser = wanted.name;
}

void Programme::note(const MadePicture& made, MonotonicTime now) {
    picture_time_.spend(from_s(made.make_ms / 1000));
    make_ms_.push_back(made.make_ms);
    if (make_ms_.size() > judged_pictures) make_ms_.pop_front();
    governor_.saw_render(made.job.level, made.render_ms + made.readback_ms,
                         !made.inverse_depth.empty(), now);
    render_ms_.add(made.render_ms);
    readback_ms_.add(made.readback_ms);
    if (last_new_) interval_ms_.add(ms_between(*last_new_, now));
    last_new_ = now;
    const ReadyInstant& instant = *made.job.instant;
    if (seek_.is_on()) seek_.saw(instant, past_pulse(), now);
    if (instant.is_live && instant.exposure && instant.set->trigger_index != latency_of_) {
        latency_of_ = instant.set->trigger_index;
        const double latency_ms = to_ms(TaiClock::now() - *instant.exposure);
        // Far before its exposure it cannot have been shown: the clocks of rig and host differ.
        constexpr double clocks_differ_ms = -1000;
        if (latency_ms > clocks_differ_ms) latency_ms_.add(latency_ms);
        state_.latency_ms = std::max(latency_ms, 0.0);
    }
}

void Programme::take_still(MonotonicTime now) {
    if (!renderer_->still) return;
    std::shared_ptr<const MadePicture> still = renderer_->still->take_finished();
    if (!still || transport().is_moving() || !is_same_view(still->job.camera, camera_) ||
        still->job.instant != instant_)
        return;
    note_rest(*still, now);
    shown_ = std::move(still);
}

void Programme::note_rest(const MadePicture& made, MonotonicTime now) {
    const bool is_best = made.job.level.rank == 0 && made.job.instant->instant->level == 0;
    if (!is_best || transport().is_moving() || rest_noted_ == changed_) return;
    rest_noted_ = changed_;
    rest_ms_.add(ms_between(changed_, now));
}

void Programme::hand_over(std::uint64_t passed_ticks, bool was_due, MonotonicTime due) {
    const MonotonicTime now = MonotonicClock::now();
    take_finished();
    const std::shared_ptr<const MadePicture> carried = newest_carried();
    const bool is_new = rendered_ && (!carried || carried->rendered == rendered_);
    {
        const std::lock_guard lock(mutex_);
        if (is_new) {
            if (!first_picture_) {
                first_picture_ = now;
                passed_ticks = 1;
            }
            ++stats_.pictures;
            stats_.faults = 0;
            for (const auto& [name, one] : renderers_) stats_.faults += one.maker->faults();
            note(*rendered_, now);
            if (settings_.sound) note_sound_delay(*rendered_->job.instant);
            shown_ = handed_ = std::exchange(rendered_, nullptr);
            note_rest(*shown_, now);
        } else if (!was_due) {
            last_new_.reset();
        }
        if (carried) {
            handed_ = carried;
        } else if (!is_new) {
            take_still(now);
            if (shown_ && is_same_view(shown_->job.camera, camera_)) handed_ = shown_;
        }
        if (!handed_) return;
        if (carried || is_new)
            operator_input_.showed(handed_->job.look,
                                   carried ? carried->rendered->job.look : shown_->job.look, now);
        if (carried)
            reprojected_way_.add(
                Reprojection::way(carried->rendered->job.camera, carried->job.camera));
        if (!is_new && was_due) ++(carried ? stats_.reprojected : stats_.repeated);
        state_.picture = handed_;
        stats_.ticks += passed_ticks;
        stats_.missed += passed_ticks - 1;
        late_ms_.add(ms_between(due, now));
        stats_.repeated += passed_ticks - 1;
        stats_.duration_s = ms_between(*first_picture_, now) / 1000;
    }
    give_to_sinks(*handed_, passed_ticks, due);
}

void Programme::note_sound_delay(const ReadyInstant& instant) {
    if (instant.number == sound_of_) return;
    sound_of_ = instant.number;
    if (instant.is_live) {
        if (instant.exposure) settings_.sound->saw_live(TaiClock::now() - *instant.exposure);
    } else if (transport().is_at_normal_speed() && transport().pulse()) {
        const double shown = static_cast<double>(instant.set->trigger_index) + instant.share;
        settings_.sound->saw_past(from_s((*transport().pulse() - shown) / settings_.pulse_rate_hz));
    }
}

PictureSound::Tick Programme::sound_tick(MonotonicTime due, std::uint64_t later) const {
    const std::chrono::nanoseconds after = from_s(static_cast<double>(later) / settings_.rate_hz);
    PictureSound::Tick tick;
    tick.now = TaiClock::now() - (MonotonicClock::now() - due) + after;
    if (transport().is_live()) {
        tick.shown_time = tick.now;
    } else if (const std::optional<double> pulse = transport().pulse();
               pulse && transport().is_at_normal_speed()) {
        const PulseGrid pulses(settings_.pulse_rate_hz);
        const double whole = std::floor(*pulse);
        tick.shown_time = pulses.time_of(static_cast<std::uint64_t>(whole)) +
                          from_s((*pulse - whole) / settings_.pulse_rate_hz) + after;
    }
    return tick;
}

void Programme::give_to_sinks(const MadePicture& shown, std::uint64_t ticks, MonotonicTime due) {
    for (std::uint64_t i = 0; i < ticks; ++i, ++sink_ticks_) {
        const ProgrammePicture picture{
            sink_ticks_,
            shown.picture,
            shown.sources ? shown.sources->picture : shown.picture,
            shown.job.instant->set,
            shown.job.camera,
            title_of(shown, static_cast<double>(sink_ticks_) / settings_.rate_hz),
            settings_.sound ? settings_.sound->next(sound_tick(due, i)) : nullptr};
        sinks_.give(picture);
    }
}

ProgrammeState Programme::state() const {
    const std::lock_guard lock(mutex_);
    return state_;
}

ProgrammeStats Programme::stats() const {
    const std::lock_guard lock(mutex_);
    ProgrammeStats stats = stats_;
    stats.sinks = sinks_.states();
    stats.late_ms = late_ms_.summary();
    stats.reprojected_way = reprojected_way_.summary();
    stats.interval_ms = interval_ms_.summary();
    stats.latency_ms = latency_ms_.summary();
    stats.input_ms = operator_input_.all_ms();
    stats.seek_ms = seek_.all_ms();
    stats.seek_steps_ms = seek_.steps_ms();
    stats.rest_ms = rest_ms_.summary();
    stats.preview_ms = preview_ms_.summary();
    stats.render_ms = render_ms_.summary();
    stats.readback_ms = readback_ms_.summary();
    return stats;
}

}  // namespace vantage
