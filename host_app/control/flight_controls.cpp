#include "host_app/control/flight_controls.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "common/base/log.h"
#include "common/base/trace/trace.h"
#include "host_app/flight/moves/move.h"

namespace vantage {
namespace {

constexpr double glide_s = 0.8;

/// Bound of the session's queue, in case that the session is held up.
constexpr std::size_t max_session_commands = 64;
constexpr double max_flight_s = 600;

}  // namespace

void TrackedCamera::put(const CameraState& camera, MonotonicTime now) {
    const std::lock_guard lock(mutex_);
    camera_ = camera;
    received_ = now;
}

std::optional<CameraState> TrackedCamera::newest(MonotonicTime now) const {
    const std::lock_guard lock(mutex_);
    return camera_ && now - received_ < timeout ? camera_ : std::nullopt;
}

void CameraGlide::begin() {
    from_ = shown_;
    remaining_ = from_ ? 1 : 0;
}

CameraState CameraGlide::step(const CameraState& flown, double dt_s) {
    remaining_ = std::max(0.0, remaining_ - dt_s / glide_s);
    const double gone = 1 - remaining_;
    shown_ = remaining_ > 0 ? mixed(*from_, flown, eased(gone)) : flown;
    return *shown_;
}

bool OperatorInputBox::put(const FlightInput& input, MonotonicTime now) {
    if (!input.is_any()) return true;
    TraceSpan span("operator input");
    const std::lock_guard lock(mutex_);
    if (!waiting_.since) waiting_.since = now;
    span.in(TraceId::of_input(*waiting_.since), TraceFlow::begins);
    const bool is_full = waiting_.input.commands.size() + input.commands.size() > max_commands;
    if (is_full)
        waiting_.input.add_axes(input);
    else
        waiting_.input.add(input);
    return !is_full;
}

OperatorInputBox::Taken OperatorInputBox::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(waiting_, {});
}

FlightControls::FlightControls(Settings settings, JogDevices* devices, RigView rig_view,
                               Framing framing, CorridorNow corridor)
    : settings_(std::move(settings)),
      cameras_(FlightController(settings_.plan.start.value_or(OrbitView{}), settings_.plan.move,
                                settings_.has_past, settings_.plan.habits)),
      fly_to_preview_s_(settings_.plan.habits.shot_s),
      devices_(devices),
      rig_view_(std::move(rig_view)),
      framing_(std::move(framing)),
      corridor_now_(std::move(corridor)) {
    cameras_.programme().flight_controller.keep(settings_.plan.book);
    shots_ = settings_.plan.book.shots;
    if (settings_.plan.move) move_ = std::make_shared<const Move>(*settings_.plan.move);
}

void FlightControls::keep_flight(Move move) {
    const std::lock_guard lock(mutex_);
    kept_flight_ = std::move(move);
}

void FlightControls::follow(const Following& found) {
    const std::lock_guard lock(mutex_);
    followed_.push_back(found);
}

CameraStep FlightControls::step(double time_s, std::optional<double> past_pulse) {
    const double dt_s = time_s - last_s_;
    last_s_ = time_s;
    if (framing_) {
        if (const std::optional<StageFraming> framing = framing_()) {
            const std::optional<OrbitView> start =
                settings_.plan.start ? std::nullopt : std::optional(framing->start);
            cameras_.for_each_controller(
                [&](FlightController& each) { each.settle(framing->limits, start); });
            framing_ = {};
        }
    }
    take_from_session();
    const std::shared_ptr<const Corridor> corridor = corridor_now_ ? corridor_now_() : nullptr;
    if (!settings_.free_flight)
        cameras_.for_each_controller([&](FlightController& each) { each.keep_within(corridor); });
    auto [input, since] = operator_input_.take();
    if (devices_) input.add(take_wheels(dt_s, since));
    CameraStep step;
    step.input = since;
    take_time(input, step);
    input.for_each<CameraCommand>([&](const auto& each) { obey(each); });
    const std::optional<double> take_s =
        settings_.take_begin && past_pulse
            ? std::optional((*past_pulse - *settings_.take_begin) / settings_.pulse_rate_hz)
            : std::nullopt;
    fly(input, dt_s, take_s, step);
    record(step, time_s, take_s);
    note_coverage(corridor.get(), step.camera.value_or(step.view.camera()), dt_s);
    const std::lock_guard lock(mutex_);
    if (auto change = cameras_.take_change()) {
        shots_ = change->book.shots;
        const std::optional<Move>& move = change->book.move;
        move_ = move ? std::make_shared<const Move>(*move) : nullptr;
        change->is_of_move |= requests_.change && requests_.change->is_of_move;
        requests_.change = std::move(change);
    }
    if (!is_recording_) pass_flight_on();
    take_session_commands(input);
    note_lines(corridor.get());
    return step;
}

void FlightControls::take_time(const FlightInput& input, CameraStep& step) {
    for (const Command& each : input.commands) {
        if (const auto* transport = std::get_if<TransportCommand>(&each))
            step.time.commands.emplace_back(*transport);
        else if (const auto* replay = std::get_if<ReplayCall>(&each))
            step.time.commands.emplace_back(*replay);
    }
    step.next_synthesiser = input.find<command::NextSynthesiser>() != nullptr;
    input.for_each<PictureCommand>([&](const auto& each) {
        if constexpr (std::is_same_v<decltype(each), const command::ToggleSourceMap&>)
            step.toggle_source_map = !step.toggle_source_map;
    });
    if (cameras_.in_hand().flight_controller.wheel_mode() == WheelMode::past) {
        step.time.pulses = input.wheel_steps;
        step.time.shuttle_pulses = input.shuttle_s * settings_.pulse_rate_hz;
    }
    const std::lock_guard lock(mutex_);
    step.time.to_pulse = std::exchange(seek_, std::nullopt);
}

void FlightControls::take_session_commands(const FlightInput& input) {
    for (const Command& each : input.commands)
        if (const auto* session = std::get_if<SessionCommand>(&each))
            if (requests_.commands.size() < max_session_commands)
                requests_.commands.push_back(*session);
}

void FlightControls::note_lines(const Corridor* corridor) {
    const CameraPair::Camera& in_hand = cameras_.in_hand();
    const CameraPair::Camera* preview = cameras_.preview();
    const std::optional<double> on_air_move =
        is_tracked_ ? std::nullopt : cameras_.programme().flight_controller.move_progress();
    lines_ = {};
    lines_.move_progress = preview ? in_hand.flight_controller.move_progress() : on_air_move;
    lines_.wheel_mode = name_of(in_hand.flight_controller.wheel_mode());
    lines_.is_tracked = is_tracked_;
    lines_.wheel = wheel_line();
    lines_.corridor = corridor_stats_;
    lines_.is_recording = is_recording_;
    lines_.holds_horizon = in_hand.flight_controller.holds_horizon();
    lines_.is_following = in_hand.follows_performer;
    lines_.keyframes = in_hand.flight_controller.keyframes();
    for (const CameraPair::Camera* camera :
         {&std::as_const(cameras_).programme(), cameras_.preview()})
        if (camera && camera->follows_performer)
            lines_.following.push_back({camera->id, camera->flight_controller.view().pivot_m});
    lines_.fly_to_preview_s = fly_to_preview_s_;
    if (!preview) return;
    const OrbitView view = preview->flight_controller.view();
    lines_.preview = {view, corridor ? std::optional(corridor->of(view.camera())) : std::nullopt,
                      cameras_.fly_progress(), on_air_move};
}

void FlightControls::obey(const command::TogglePreview&) { cameras_.toggle_preview(); }

bool FlightControls::has_preview_to_show() const {
    if (cameras_.preview()) return true;
    log_info(
        "there is no camera on preview to cut or fly to; add one with the command preview or the "
        "key /");
    return false;
}

void FlightControls::obey(const command::Cut&) {
    if (!has_preview_to_show()) return;
    cameras_.cut();
    // A cut from a tracked camera does not glide.
    is_tracked_ = may_track_ = false;
    glide_ = {};
}

void FlightControls::obey(const command::FlyToPreview&) {
    if (!has_preview_to_show()) return;
    cameras_.fly_to_preview(fly_to_preview_s_);
    may_track_ = false;
}

void FlightControls::obey(const command::SetFlyDuration& set) {
    fly_to_preview_s_ = set.duration_s;
}

void FlightControls::obey(const command::ToggleTracking&) { may_track_ = !may_track_; }

void FlightControls::obey(const command::ToggleFollow&) {
    bool& follows = cameras_.in_hand().follows_performer;
    follows = !follows;
}

void FlightControls::obey(const command::ToggleRecording&) { is_recording_ = !is_recording_; }

void FlightControls::obey(const command::ToggleJogMap&) {
    wheels_.toggle();
    mapper_.let_go();
}

void FlightControls::fly(const FlightInput& input, double dt_s, std::optional<double> take_s,
                         CameraStep& step) {
    FlightController& programme = cameras_.programme().flight_controller;
    FlightController& in_hand = cameras_.in_hand().flight_controller;
    const bool wheel_steers = input.turns_wheel() && in_hand.wheel_mode() != WheelMode::past;
    if (!cameras_.preview() &&
        (input.steers() || input.find<command::ToggleMove>() || wheel_steers))
        may_track_ = false;
    const std::optional<CameraState> tracked =
        may_track_ ? tracked_.newest(MonotonicClock::now()) : std::nullopt;
    // Before the operator's input, which steers on from there.
    if (tracked) programme.stand_at(*tracked);
    if (tracked.has_value() != is_tracked_) {
        is_tracked_ = tracked.has_value();
        glide_.begin();
    }
    if (settings_.take_begin && programme.move_take_s()) {
        // The move sets the time, so holding the time pauses the move, and going elsewhere leaves
        // it.
        const std::size_t holds = std::erase_if(step.time.commands, [](const TimeCommand& each) {
            const auto* transport = std::get_if<TransportCommand>(&each);
            return transport && std::holds_alternative<command::ToggleHold>(*transport);
        });
        if (holds % 2 == 1) programme.toggle_pause();
        if (step.time.moves_time()) programme.leave_move();
    }
    // Input or a move that takes the pivot elsewhere ends following.
    if (input.moves_pivot() || in_hand.move_progress())
        cameras_.in_hand().follows_performer = false;
    in_hand.take(input, rig_view_, take_s);
    cameras_.advance(dt_s);
    show(dt_s, tracked, step);
}

void FlightControls::show(double dt_s, const std::optional<CameraState>& tracked,
                          CameraStep& step) {
    const FlightController& programme = cameras_.programme().flight_controller;
    if (const std::optional<double> led = programme.move_take_s(); led && settings_.take_begin)
        step.time.at_pulse = *settings_.take_begin + *led * settings_.pulse_rate_hz;
    step.view = programme.view();
    const CameraState shown = glide_.step(tracked.value_or(step.view.camera()), dt_s);
    if (is_tracked_ || !glide_.is_over()) step.camera = shown;
    if (const CameraPair::Camera* preview = cameras_.preview())
        step.preview = preview->flight_controller.view();
}

CameraStep FlightControls::fly_to_shot(int number) {
    may_track_ = false;
    if (std::exchange(is_tracked_, false)) glide_.begin();
    CameraPair::Camera& programme = cameras_.programme();
    programme.follows_performer = false;
    programme.flight_controller.take({.commands = {command::RecallShot{number}}}, rig_view_);
    CameraStep step;
    show(0, std::nullopt, step);
    return step;
}

void FlightControls::seek(double pulse) {
    const std::lock_guard lock(mutex_);
    seek_ = pulse;
}

FlightControls::Shots FlightControls::shots() const {
    const std::lock_guard lock(mutex_);
    return shots_;
}

void FlightControls::take_from_session() {
    std::optional<Move> flight;
    std::vector<Following> followed;
    {
        const std::lock_guard lock(mutex_);
        flight = std::exchange(kept_flight_, std::nullopt);
        followed = std::exchange(followed_, {});
    }
    if (flight) {
        cameras_.in_hand().flight_controller.keep_flight(*flight);
        const std::lock_guard lock(mutex_);
        move_ = std::make_shared<const Move>(*std::move(flight));
    }
    for (const Following& found : followed)
        if (CameraPair::Camera* camera = cameras_.find(found.camera);
            camera && camera->follows_performer)
            camera->flight_controller.carry_pivot_to(found.pivot_m);
}

void FlightControls::record(const CameraStep& step, double time_s, std::optional<double> take_s) {
    if (!is_recording_) return;
    const OrbitView view =
        step.preview ? *step.preview
        : step.camera
            ? orbit_view_of(*step.camera, flight_.empty() ? step.view.azimuth_rad
                                                          : flight_.back().view.azimuth_rad)
            : step.view;
    if (flight_.empty() || time_s > flight_.back().time_s)
        flight_.push_back({time_s, view, take_s});
    if (time_s - flight_.front().time_s > max_flight_s) {
        log_warning("the recording of the flight ended at its limit of {:.0f} s", max_flight_s);
        is_recording_ = false;
    }
}

std::shared_ptr<const Move> FlightControls::move() const {
    const std::lock_guard lock(mutex_);
    return move_;
}

SessionRequests FlightControls::take_requests() {
    const std::lock_guard lock(mutex_);
    return std::exchange(requests_, {});
}

void FlightControls::end_recording() {
    const std::lock_guard lock(mutex_);
    pass_flight_on();
}

void FlightControls::pass_flight_on() {
    if (flight_.empty()) return;
    requests_.flight = std::exchange(flight_, {});
    requests_.limits = cameras_.in_hand().flight_controller.limits();
}

void FlightControls::note_coverage(const Corridor* corridor, const CameraState& camera,
                                   double dt_s) {
    if (!corridor) return;
    const Coverage now = corridor->of(camera);
    corridor_stats_.now = now;
    corridor_stats_.least_share = std::min(corridor_stats_.least_share, now.share);
    switch (Corridor::place_of(now.share)) {
        case CorridorPlace::inside:
            break;
        case CorridorPlace::edge:
            corridor_stats_.edge_s += dt_s;
            break;
        case CorridorPlace::beyond:
            corridor_stats_.beyond_s += dt_s;
            break;
    }
}

FlightControls::Lines FlightControls::lines() const {
    const std::lock_guard lock(mutex_);
    return lines_;
}

FlightInput FlightControls::take_wheels(double dt_s, std::optional<MonotonicTime>& since) {
    const bool is_map_open = wheels_.is_open();
    while (std::optional<DeckEvent> event = devices_->next()) {
        wheels_.note(*event);
        if (is_map_open) continue;
        mapper_.take(*event);
        if (event->kind == DeckEvent::Kind::control && (!since || event->time < *since))
            since = event->time;
    }
    return mapper_.input(dt_s);
}

std::string FlightControls::wheel_line() const {
    if (!devices_) return "";
    std::string names, fault;
    for (const DeckDevice& device : devices_->devices()) {
        if (device.usable)
            names += (names.empty() ? "" : ", ") + device.model;
        else if (!device.fault.empty())
            fault = device.fault;
    }
    if (names.empty()) return fault;
    return fmt::format(
        "{} {}{}{}", names,
        wheels_.is_open() ? "moves nothing while its map is open"
                          : fmt::format("drives the {}",
                                        name_of(cameras_.in_hand().flight_controller.wheel_mode())),
        mapper_.is_storing() ? "; the next shot button stores" : "",
        wheels_.unsaved().empty() ? "" : "; its map has unsaved changes");
}

}  // namespace vantage
