#include "host_app/live/live_session.h"

#include <algorithm>
#include <numbers>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/gl/limits.h"
#include "common/image/image_file.h"
#include "host_app/live/depth_views.h"
#include "host_app/live/disparity_picture.h"
#include "host_app/output/contact_sheet.h"

namespace vantage {
namespace {

constexpr std::size_t sheet_moments = 5;
constexpr int sheet_cell_px = 480;

double ms_since(MonotonicTime start) {
    return std::chrono::duration<double, std::milli>(MonotonicClock::now() - start).count();
}

/// The states of the rigs that are not in the set; of all, without one.
std::string states_of_missing(const ReceiverStatus& status, const FrameSet* set) {
    std::string text;
    for (const RigStatus& rig : status.rigs) {
        if (set &&
            std::any_of(set->slots.begin(), set->slots.end(), [&](const FrameSet::Slot& slot) {
                return slot.frame && slot.rig == rig.rig;
            }))
            continue;
        text += fmt::format("{}{} {}", text.empty() ? "" : "; ", rig.rig, state_of(rig));
        if (!rig.last_error.empty() && rig.refused.empty())
            text += fmt::format(" ({})", rig.last_error);
    }
    return text;
}

Percentiles worst(const ReceiverStatus& status, Percentiles RigStatus::*times) {
    Percentiles most;
    for (const RigStatus& rig : status.rigs)
        if ((rig.*times).count > 0 && (rig.*times).p95 >= most.p95) most = rig.*times;
    return most;
}

VirtualView target_of(const OrbitView& view, const LiveSettings& settings) {
    return {settings.width_px, settings.height_px, view.K(settings.width_px, settings.height_px),
            view.world_from_camera()};
}

/// The virtual view, and one rig's colour and disparity.
SheetMoment row_of(const Moment& moment, std::size_t row) {
    SheetMoment stills{moment.title, {{moment.picture, "virtual view"}}};
    std::vector<const RigFrame*> frames;
    for (const FrameSet::Slot& slot : moment.set.slots)
        if (slot.frame) frames.push_back(slot.frame.get());
    if (frames.empty()) return stills;
    // Every row shows another rig.
    const RigFrame& frame = *frames[row % frames.size()];
    stills.stills.push_back({frame.colour, fmt::format("{}: colour", frame.rig)});
    stills.stills.push_back(
        {disparity_picture(frame), fmt::format("{}: disparity, 0 (blue) to {:.0f} px (red)",
                                               frame.rig, frame.max_disparity_px)});
    return stills;
}

}  // namespace

LiveSession::LiveSession(const LiveSettings& settings, const ShaderLibrary& shaders, StageFeed feed)
    : settings_(settings),
      shaders_(&shaders),
      past_(settings.past_bytes),
      newest_(settings.past_bytes > 0 ? kept_feed(std::move(feed), past_) : std::move(feed)),
      synthesiser_(make_synthesiser(settings.synthesiser, shaders)),
      overlay_(shaders),
      moments_(sheet_moments) {
    if (!settings.film.empty())
        recorder_.emplace(settings.film, VideoSettings{.width_px = settings.width_px,
                                                       .height_px = settings.height_px,
                                                       .rate_hz = settings.rate_hz});
    if (settings_.novelty) NoveltyOverlay::require(*synthesiser_, settings_.synthesiser);
    if (settings_.stereoscopy)
        (void)settings_.stereoscopy->settled(target_of(OrbitView{}, settings_), 1);
    refresh_status();
    for (const RigStatus& rig : status_.rigs) overlay_.name_rigs({rig.rig});
}

const ReceiverStatus& LiveSession::refresh_status() {
    status_ = newest_.status();
    return status_;
}

void LiveSession::wait_for_rigs(std::chrono::nanoseconds limit, StopSignal& stop) {
    const MonotonicTime start = MonotonicClock::now();
    const MonotonicTime deadline = start + limit;
    log_info("waiting for {} rigs", status_.rigs.size());
    while (MonotonicClock::now() < deadline) {
        if (stop.requested())
            fail(
                "interrupted after {:.1f} s of waiting for the rigs, before anything was flown: {}",
                ms_since(start) / 1000, states_of_missing(status_, shown()));
        if (std::optional<FrameSet> set = newest_.take(std::chrono::milliseconds(50))) {
            const bool all = set->present() == static_cast<int>(set->slots.size());
            show(std::move(*set));
            if (all) return;
        }
        refresh_status();
        if (!status_.rigs.empty() &&
            std::all_of(status_.rigs.begin(), status_.rigs.end(),
                        [](const RigStatus& rig) { return !rig.refused.empty(); }))
            fail("every rig refuses this host: {}", states_of_missing(status_, shown()));
    }
    const double limit_s = std::chrono::duration<double>(limit).count();
    if (!shown_)
        fail("no frame of any rig came within {:g} s; are the rigs running? ({})", limit_s,
             states_of_missing(status_, shown()));
    log_warning("after {:g} s these rigs are missing: {}", limit_s,
                states_of_missing(status_, shown()));
}

std::vector<DepthView> LiveSession::views_of(const FrameSet& set) const {
    std::vector<DepthView> views;
    for (const FrameSet::Slot& slot : set.slots) {
        if (!slot.frame) continue;
        views.push_back(depth_view_of(*slot.frame));
        const auto colour = settings_.colours.find(slot.rig);
        if (colour != settings_.colours.end()) views.back().colour_correction = colour->second;
    }
    return views;
}

void LiveSession::give_to_synthesiser(std::vector<DepthView> views, std::uint64_t trigger_index) {
    const auto pulses_of_cut = static_cast<std::uint64_t>(settings_.pulse_rate_hz) + 1;
    if (shown_ && (trigger_index < shown_->trigger_index ||
                   trigger_index > shown_->trigger_index + pulses_of_cut))
        synthesiser_->forget();
    if (settings_.harmonise)
        for (DepthView& view : views) harmoniser_.apply(view);
    synthesiser_->set_views(views);
    demand_.see(views);
}

void LiveSession::travel(double pulses) {
    const std::optional<PastRing::Span> span = past_.span();
    if (!span || !shown_) return;
    const double from = past_pulse_.value_or(static_cast<double>(shown_->trigger_index));
    past_pulse_ = std::clamp(from + pulses, static_cast<double>(span->oldest),
                             static_cast<double>(span->newest));
}

void LiveSession::to_live() {
    past_pulse_.reset();
    frozen_ = false;
}

std::optional<double> LiveSession::behind_s() const {
    const std::optional<PastRing::Span> span = past_.span();
    if (!past_pulse_ || !span) return std::nullopt;
    return std::max(0.0,
                    (static_cast<double>(span->newest) - *past_pulse_) / settings_.pulse_rate_hz);
}

void LiveSession::show(FrameSet set) {
    const MonotonicTime start = MonotonicClock::now();
    for (const FrameSet::Slot& slot : set.slots) {
        if (!slot.frame) continue;
        times_.add(Stage::capture, slot.frame->times.capture_ms);
        times_.add(Stage::rectify, slot.frame->times.rectify_ms);
        times_.add(Stage::match, slot.frame->times.match_ms);
        times_.add(Stage::pack, slot.frame->times.pack_ms);
    }
    std::vector<DepthView> views = views_of(set);
    if (settings_.harmonise) {
        const double pulses = last_harmonised_ > 0 && set.trigger_index > last_harmonised_
                                  ? static_cast<double>(set.trigger_index - last_harmonised_)
                                  : 0;
        harmoniser_.see(views, pulses / settings_.pulse_rate_hz);
        last_harmonised_ = set.trigger_index;
    }
    give_to_synthesiser(std::move(views), set.trigger_index);
    times_.add(Stage::upload, ms_since(start));
    count_frames(set, fused_);
    ++sets_fused_;
    shown_ = std::move(set);
    is_new_ = true;
}

void LiveSession::ask_for_rigs(const VirtualView& view) {
    for (const RigDemand::Change& change : demand_.update(view, MonotonicClock::now())) {
        log_info("asking rig {} to {} sending", change.rig, change.streaming ? "start" : "stop");
        newest_.ask(change.rig, change.streaming);
    }
}

const Texture& LiveSession::render_eye(const VirtualView& eye) {
    const Texture& plain = synthesiser_->render(eye);
    const PixelOrigins* origins = synthesiser_->origins();
    last_eye_ = origins ? &overlay_.lay(plain, *origins) : &plain;
    return *last_eye_;
}

const Texture& LiveSession::render(const VirtualView& target, double focus_m) {
    if (!settings_.stereoscopy) return render_eye(target);
    const auto [left, right] = eye_views(target, settings_.stereoscopy->settled(target, focus_m));
    side_by_side_.resize({target.width_px, target.height_px});
    side_by_side_.put_left(render_eye(left));
    side_by_side_.put_right(render_eye(right));
    return side_by_side_.picture();
}

const Texture& LiveSession::make_picture(const OrbitView& view, std::chrono::nanoseconds time) {
    if (past_pulse_) {
        std::optional<FrameSet> set = past_.at(*past_pulse_);
        if (set && set->trigger_index != shown_->trigger_index) {
            give_to_synthesiser(views_of(*set), set->trigger_index);
            shown_ = std::move(set);
        }
    } else if (!frozen_) {
        if (std::optional<FrameSet> set = newest_.take()) show(std::move(*set));
    }
    const MonotonicTime start = MonotonicClock::now();
    if (!first_picture_) first_picture_ = start;
    const VirtualView target = target_of(view, settings_);
    ask_for_rigs(target);
    const Texture& texture = render(target, view.distance_m);
    glFinish();
    times_.add(Stage::render, ms_since(start));
    check_gl("rendering the virtual view");
    if (is_new_) {
        std::optional<TaiTime> exposure;
        for (const FrameSet::Slot& slot : shown_->slots)
            if (slot.frame && (!exposure || slot.frame->exposure < *exposure))
                exposure = slot.frame->exposure;
        if (exposure) {
            latest_latency_ms_ =
                std::chrono::duration<double, std::milli>(TaiClock::now() - *exposure).count();
            latency_ms_.add(latest_latency_ms_);
        }
        is_new_ = false;
    }

    const bool for_sheet = !settings_.contact_sheet.empty() && shown_ && moments_.wants(pictures_);
    if (recorder_ || for_sheet) {
        const MonotonicTime read_start = MonotonicClock::now();
        const ColourImage picture = texture.download();
        times_.add(Stage::readback, ms_since(read_start));
        if (for_sheet) keep_moment(view, time, picture);
        if (recorder_) recorder_->add(picture, time);
    }
    last_texture_ = &texture;
    last_view_ = view;
    ++pictures_;
    last_picture_ = MonotonicClock::now();
    return texture;
}

void LiveSession::keep_moment(const OrbitView& view, std::chrono::nanoseconds time,
                              const ColourImage& picture) {
    constexpr double deg = 180 / std::numbers::pi;
    const std::string title = fmt::format(
        "{:.1f} s   pulse {}   {} of {} rigs   camera at azimuth {:.0f}, elevation {:.0f} degrees, "
        "{:.1f} m",
        std::chrono::duration<double>(time).count(), shown_->trigger_index, shown_->present(),
        shown_->slots.size(), view.azimuth_rad * deg, view.elevation_rad * deg, view.distance_m);
    moments_.add({title, picture, *shown_});
}

void LiveSession::next_synthesiser() {
    const std::vector<SynthesiserEntry> entries = synthesiser_entries();
    const auto current = std::find_if(
        entries.begin(), entries.end(),
        [&](const SynthesiserEntry& entry) { return entry.name == settings_.synthesiser; });
    const SynthesiserEntry& next =
        current == entries.end() || current + 1 == entries.end() ? entries.front() : *(current + 1);
    if (next.name == settings_.synthesiser) return;
    synthesiser_ = next.make(*shaders_);
    settings_.synthesiser = next.name;
    synthesiser_->note_origins(settings_.novelty);
    if (shown_) give_to_synthesiser(views_of(*shown_), shown_->trigger_index);
}

void LiveSession::set_novelty(bool novelty) {
    settings_.novelty = novelty;
    synthesiser_->note_origins(novelty);
}

std::optional<NoveltyShares> LiveSession::last_shares() const {
    if (!last_eye_ || !synthesiser_->origins()) return std::nullopt;
    return novelty_shares(last_eye_->download(), *synthesiser_->origins());
}

std::vector<StageTime> LiveSession::stage_summary() const {
    std::vector<StageTime> times = times_.summary();
    times[static_cast<std::size_t>(Stage::network)].ms = worst(status_, &RigStatus::network_ms);
    times[static_cast<std::size_t>(Stage::decode)].ms = worst(status_, &RigStatus::decode_ms);
    return times;
}

LiveReport LiveSession::report() const {
    LiveReport report;
    report.width_px = settings_.width_px;
    report.height_px = settings_.height_px;
    report.rate_hz = settings_.rate_hz;
    report.synthesiser = settings_.synthesiser;
    report.renderer = GlInfo::query().renderer;
    if (first_picture_)
        report.duration_s = std::chrono::duration<double>(last_picture_ - *first_picture_).count();
    report.pictures = pictures_;
    report.view = last_view_;

    const NewestSet::Superseded superseded = newest_.superseded();
    report.sets_closed = status_.sets;
    report.sets_complete = status_.complete_sets;
    report.sets_dropped = status_.sets_dropped;
    report.sets_fused = sets_fused_;
    report.sets_superseded = superseded.sets;
    const auto count_of = [](const RigCounts& counts, const std::string& rig) {
        const auto found = counts.find(rig);
        return found == counts.end() ? 0 : found->second;
    };
    for (const RigStatus& rig : status_.rigs)
        report.rigs.push_back(
            {rig, count_of(fused_, rig.rig), count_of(superseded.frames, rig.rig)});

    for (RigAccount& rig : report.rigs)
        if (const auto found = harmoniser_.rigs().find(rig.status.rig);
            found != harmoniser_.rigs().end())
            rig.harmony = found->second;
    report.stages = stage_summary();
    if (recorder_) {
        report.stages[static_cast<std::size_t>(Stage::encode)].ms = recorder_->encode_ms();
        report.film = settings_.film.string();
        report.film_pictures = recorder_->frames();
        report.film_dropped = recorder_->dropped();
    }
    report.latency_ms = latency_ms_.summary();
    report.novelty = last_shares();
    if (settings_.stereoscopy)
        report.stereoscopy =
            settings_.stereoscopy->settled(target_of(last_view_, settings_), last_view_.distance_m);
    return report;
}

void LiveSession::finish() {
    status_ = newest_.close();
    if (pictures_ == 0) return;
    if (recorder_) recorder_->finish();
    if (settings_.contact_sheet.empty()) return;
    std::vector<SheetMoment> rows;
    for (const Moment& moment : moments_.chosen()) rows.push_back(row_of(moment, rows.size()));
    if (rows.empty()) return;
    write_colour_image(
        settings_.contact_sheet,
        compose_contact_sheet("Vantage: flight of the virtual camera", rows, sheet_cell_px));
}

}  // namespace vantage
