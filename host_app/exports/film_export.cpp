#include "host_app/exports/film_export.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <nlohmann/json.hpp>

#include "common/base/cli/version.h"
#include "common/base/error.h"
#include "common/base/time/pulse_grid.h"
#include "common/gl/context/egl_context.h"
#include "common/gl/context/limits.h"
#include "common/take/take_pulses.h"
#include "host_app/exports/film_parts.h"
#include "host_app/exports/take_export.h"
#include "host_app/foreground/motion/interpolated_frame_sets.h"
#include "host_app/output/media/film_file.h"
#include "host_app/output/picture_sink.h"
#include "host_app/refine/gain_compensation.h"
#include "host_app/sound/picture_sound.h"
#include "host_app/sound/sound_source.h"
#include "host_app/takes/take_frame_sets.h"
#include "host_app/takes/take_show.h"
#include "host_app/views/depth_view.h"

namespace vantage {
namespace {

/// The part of a take before the first picture from which the background is learnt, and its frame
/// sets per second. Performers move, so that the background behind them becomes visible.
constexpr double learning_s = 20, learning_rate_hz = 5;
/// Temporal filters see every frame set of this long before the first picture.
constexpr double settling_s = 1;
/// A time nearer to a pulse than this share of the period is that pulse.
constexpr double least_share = 0.01;
/// Frame sets further apart are not used to interpolate or filter each other.
constexpr double longest_gap_s = 1;
/// x264's constant rate factor for a film that will be edited.
constexpr double film_quality = 16;
constexpr std::size_t most_pictures = 10'000'000;

std::size_t pictures_of(double duration_s, double rate_hz) {
    const double count = std::max(1.0, std::round(duration_s * rate_hz));
    if (count > most_pictures)
        fail("a film of {:.0f} s at {:g} fps is too long: the limit is {} pictures", duration_s,
             rate_hz, most_pictures);
    return static_cast<std::size_t>(count);
}

/// Prepares instants of a take in the order in which a film needs them.
class FilmInstants {
  public:
    FilmInstants(std::shared_ptr<const TakeReader> take, const SynthesiserEntry& synthesiser,
                 const ShaderLibrary& shaders)
        : show_(take_show_from(take->facts().show)),
          rate_hz_(take->facts().pulse_rate_hz),
          sets_(std::move(take)),
          preparer_(synthesiser.make_preparer(shaders)) {}

    /// Prepares the instant at `pulse`, interpolated between neighbouring pulses if it is between
    /// them.
    void go_to(double pulse, const VirtualView& target) {
        const std::uint64_t there = *sets_.pulse_at(pulse);
        const double passed = pulse - static_cast<double>(there);
        const double share = passed > least_share && passed < 1 - least_share ? passed : 0;
        const double moment = static_cast<double>(there) + share;
        if (moment_ && *moment_ == moment) return;
        const double dt_s =
            moment_ && moment > *moment_ ? (moment - *moment_) / rate_hz_ : 2 * longest_gap_s;
        moment_ = moment;
        const FrameSet set =
            share > 0 ? *between_.at(sets_, there, share) : *sets_.at(static_cast<double>(there));
        if (dt_s > longest_gap_s) preparer_->cut();
        std::vector<DepthView> views = depth_views_of(set, show_.colours);
        if (share == 0) gain_compensation_.see(views, std::min(dt_s, longest_gap_s));
        for (DepthView& view : views) gain_compensation_.apply(view);
        preparer_->take(views, std::min(dt_s, longest_gap_s));
        for (std::size_t rig = 0; rig < views.size(); ++rig) preparer_->improve(target);
    }
    std::shared_ptr<const Instant> prepared(const VirtualView& target) {
        return preparer_->prepare(target, prepare_levels().front());
    }
    const TakeFrameSets& sets() const { return sets_; }

  private:
    TakeShow show_;
    double rate_hz_;
    TakeFrameSets sets_;
    InterpolatedFrameSets between_;
    GainCompensation gain_compensation_;
    std::unique_ptr<InstantPreparer> preparer_;
    std::optional<double> moment_;  ///< time in pulses
};

/// Identifies the film, so that parts of another film are not resumed.
nlohmann::ordered_json claim_of(const std::vector<FilmPicture>& pictures,
                                const FilmSettings& settings) {
    std::string all;
    for (const FilmPicture& picture : pictures) {
        const auto add = [&](const double* numbers, std::size_t count) {
            all.append(reinterpret_cast<const char*>(numbers), count * sizeof *numbers);
        };
        const CameraState& camera = picture.camera;
        add(&picture.pulse, 1);
        add(camera.world_from_camera.matrix().data(), 16);
        add(&camera.field_of_view_rad, 1);
        add(&camera.focus_m, 1);
    }
    const PictureFormat& format = settings.format;
    nlohmann::ordered_json claim{{"film", version()},
                                 {"pictures", pictures.size()},
                                 {"pictures_crc32", crc32(std::as_bytes(std::span(all)))},
                                 {"width_px", format.width_px},
                                 {"height_px", format.height_px},
                                 {"rate_hz", settings.rate_hz},
                                 {"synthesiser", settings.synthesiser}};
    if (format.stereoscopy) claim["stereoscopy"] = to_json(*format.stereoscopy);
    return claim;
}

/// Renders the missing parts of a film.
class FilmWork {
  public:
    FilmWork(std::shared_ptr<const TakeReader> take, const std::vector<FilmPicture>& pictures,
             const FilmSettings& settings)
        : pictures_(pictures),
          settings_(settings),
          pulse_rate_hz_(take->facts().pulse_rate_hz),
          synthesiser_(find_synthesiser(settings.synthesiser)),
          instants_(std::move(take), synthesiser_, shaders_),
          painter_(synthesiser_, settings.format, shaders_) {}

    void render(FilmParts& parts, const std::function<bool()>& is_wanted,
                const std::function<void(double)>& progress) {
        learn(parts.pictures(), is_wanted);
        while (parts.pictures() < pictures_.size() && render_part(parts, is_wanted, progress)) {
        }
    }

  private:
    /// A GL context that meets Vantage's requirements.
    struct Gl {
        EglContext context;
        Gl() { GlInfo::query().require_vantage_minimum(); }
    };

    VirtualView view(const FilmPicture& picture) const {
        return view_of(picture.camera, {settings_.format.width_px, settings_.format.height_px});
    }

    /// Learns the background from before the picture at `begin`, and if that is short, from after
    /// it; then prepares the pictures just before it for temporal filters.
    void learn(std::uint64_t begin, const std::function<bool()>& is_wanted) {
        const PastFrameSets::Span span = *instants_.sets().span();
        const auto pulses_of = [this](double time_s) {
            return static_cast<std::uint64_t>(std::llround(time_s * pulse_rate_hz_));
        };
        const auto before = [&](std::uint64_t pulse, double time_s) {
            return pulse - std::min(pulse - span.oldest, pulses_of(time_s));
        };
        const auto see = [&](std::uint64_t from, std::uint64_t to, std::uint64_t every,
                             const FilmPicture& picture) {
            for (std::uint64_t pulse = from; pulse < to && is_wanted(); pulse += every)
                instants_.go_to(static_cast<double>(pulse), view(picture));
        };
        const std::uint64_t first =
            before(*instants_.sets().pulse_at(pictures_[begin].pulse), learning_s);
        const auto every =
            std::max<std::uint64_t>(1, std::llround(pulse_rate_hz_ / learning_rate_hz));
        see(first, std::min(first + pulses_of(learning_s), span.newest), every, pictures_[begin]);
        const auto settling =
            static_cast<std::uint64_t>(std::llround(settling_s * settings_.rate_hz));
        const std::uint64_t begun = begin - std::min(begin, settling);
        if (begun == 0) {
            const std::uint64_t front = *instants_.sets().pulse_at(pictures_.front().pulse);
            see(before(front, settling_s), front, 1, pictures_.front());
        }
        for (std::uint64_t i = begun; i < begin && is_wanted(); ++i)
            instants_.go_to(pictures_[i].pulse, view(pictures_[i]));
    }

    /// Returns false if the part was cut short because `is_wanted` became false.
    bool render_part(FilmParts& parts, const std::function<bool()>& is_wanted,
                     const std::function<void(double)>& progress) {
        const std::uint64_t begin = parts.pictures();
        const std::uint64_t end =
            std::min<std::uint64_t>(begin + settings_.part_pictures, pictures_.size());
        VideoWriter part(parts.next(), {.width_px = settings_.format.width_px,
                                        .height_px = settings_.format.height_px,
                                        .rate_hz = settings_.rate_hz,
                                        .quality = film_quality});
        std::uint64_t i = begin;
        for (; i < end && is_wanted(); ++i) {
            if (progress) progress(static_cast<double>(i) / static_cast<double>(pictures_.size()));
            const VirtualView target = view(pictures_[i]);
            instants_.go_to(pictures_[i].pulse, target);
            const std::shared_ptr<const Instant> instant = instants_.prepared(target);
            part.add(painter_.paint(*instant, pictures_[i].camera, render_levels().front()),
                     static_cast<std::int64_t>(i - begin));
        }
        if (i == begin) return false;
        part.finish();
        parts.add(i - begin);
        return i == end;
    }

    const std::vector<FilmPicture>& pictures_;
    const FilmSettings& settings_;
    double pulse_rate_hz_;
    SynthesiserEntry synthesiser_;
    Gl gl_;
    ShaderLibrary shaders_;
    FilmInstants instants_;
    ViewPainter painter_;
};

}  // namespace

std::vector<FilmPicture> film_of(const Move& move, const TakeReader& take, const TakePart& part,
                                 double rate_hz) {
    const PulseSpan span = pulse_span_of(take);
    const double pulse_rate_hz = take.facts().pulse_rate_hz;
    const bool leads = move.take_s_at(0).has_value();
    const auto first = static_cast<double>(leads ? span.first : std::max(part.from, span.first));
    const auto last = static_cast<double>(std::min(part.to, span.last + 1));
    const double duration_s = leads ? move.duration_s() : (last - first) / pulse_rate_hz;
    if (duration_s < 0) fail("{} has no frame in that range", take.path().string());
    std::vector<FilmPicture> pictures(pictures_of(duration_s, rate_hz));
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        const double time_s = static_cast<double>(i) / rate_hz;
        pictures[i].camera = move.at(time_s).camera();
        // A time within rounding errors of a pulse is that pulse.
        constexpr double rounding = 1e-6;
        pictures[i].pulse =
            first + move.take_s_at(time_s).value_or(time_s) * pulse_rate_hz + rounding;
    }
    return pictures;
}

std::vector<FilmPicture> film_of_cameras(const TakeReader& take, const TakePart& part,
                                         double rate_hz) {
    std::vector<CameraRecord> ticks;
    for (const CameraRecord& camera : take.cameras())
        if (camera.pulse >= part.from && camera.pulse < part.to) ticks.push_back(camera);
    if (ticks.empty())
        fail("{} has no recorded camera in that range; give a flight with --path",
             take.path().string());
    // Ticks are evenly spaced, although their recorded times are not.
    const double span_s =
        std::chrono::duration<double>(ticks.back().time - ticks.front().time).count();
    const auto steps = static_cast<double>(ticks.size() - 1);
    const double tick_s = steps > 0 && span_s > 0 ? span_s / steps : 1 / rate_hz;
    std::vector<FilmPicture> pictures(
        pictures_of(tick_s * static_cast<double>(ticks.size()), rate_hz));
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        constexpr double rounding = 1e-6;
        const double at = std::min(static_cast<double>(i) / rate_hz / tick_s + rounding, steps);
        const auto here = static_cast<std::size_t>(at);
        const CameraRecord& a = ticks[here];
        pictures[i].pulse = static_cast<double>(a.pulse);
        pictures[i].camera =
            here + 1 < ticks.size()
                ? mixed(camera_of(a), camera_of(ticks[here + 1]), at - static_cast<double>(here))
                : camera_of(a);
    }
    return pictures;
}

ExportStats export_film(std::shared_ptr<const TakeReader> take,
                        const std::vector<FilmPicture>& pictures, const FilmSettings& settings,
                        const std::filesystem::path& file, const std::function<bool()>& is_wanted,
                        const std::function<void(double)>& progress) {
    if (std::filesystem::exists(file))
        fail("{} already exists; choose another name for the film", file.string());
    const SynthesiserEntry synthesiser = find_synthesiser(settings.synthesiser);
    require_film_name(file);
    const std::filesystem::path folder = FilmParts::folder_of(file);
    claim_folder(folder, *take, claim_of(pictures, settings));
    FilmParts parts(folder, settings.rate_hz);
    ExportStats stats{0, parts.pictures(), 0};
    const TakeFrameSets sets(take);
    const SetTimecode timecodes(take->facts().pulse_rate_hz, settings.rate_hz);
    const std::string timecode = timecodes.of(*sets.at(pictures.front().pulse));
    if (parts.pictures() < pictures.size())
        FilmWork(take, pictures, settings).render(parts, is_wanted, progress);
    stats.written = parts.pictures() - stats.there;
    if (parts.pictures() < pictures.size()) return stats;
    parts.join(file, timecode, sound_of_film(take, pictures, settings.rate_hz));
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
    return stats;
}

namespace {

/// Whether pictures around one advance by as many pulses as at normal speed.
bool is_at_normal_speed(const std::vector<FilmPicture>& pictures, std::size_t at,
                        std::size_t around, double pulses_a_picture) {
    const std::size_t first = at - std::min(at, around);
    const std::size_t last = std::min(at + around, pictures.size() - 1);
    const double due = pulses_a_picture * static_cast<double>(last - first);
    // A picture shows the newest pulse, so either end may be off by one.
    return std::abs(pictures[last].pulse - pictures[first].pulse - due) <=
           std::max(1.01, 0.05 * due);
}

}  // namespace

std::vector<std::optional<TaiTime>> even_times(const std::vector<FilmPicture>& pictures,
                                               double rate_hz, double pulse_rate_hz) {
    const double pulses_a_picture = pulse_rate_hz / rate_hz;
    const auto around =
        static_cast<std::size_t>(std::ceil(std::max(rate_hz / 2, 3 / pulses_a_picture)));
    const PulseGrid pulses(pulse_rate_hz);
    std::vector<std::optional<TaiTime>> times(pictures.size());
    for (std::size_t begin = 0; begin < pictures.size();) {
        std::size_t end = begin;
        // The smallest delay of the run's first picture behind its pulse.
        double first = pictures[begin].pulse;
        while (end < pictures.size() &&
               is_at_normal_speed(pictures, end, around, pulses_a_picture)) {
            first = std::max(
                first, pictures[end].pulse - pulses_a_picture * static_cast<double>(end - begin));
            ++end;
        }
        const double whole = std::floor(first);
        const TaiTime start = pulses.time_of(static_cast<std::uint64_t>(whole)) +
                              from_s((first - whole) / pulse_rate_hz);
        for (std::size_t i = begin; i < end; ++i)
            times[i] = start + from_s(static_cast<double>(i - begin) / rate_hz);
        begin = std::max(end, begin + 1);
    }
    return times;
}

std::vector<std::shared_ptr<const SoundBlock>> sound_of_film(
    const std::shared_ptr<const TakeReader>& take, const std::vector<FilmPicture>& pictures,
    double rate_hz) {
    std::vector<std::shared_ptr<const SoundBlock>> blocks;
    if (!take->facts().has_sound) return blocks;
    PictureSound sound({.rate_hz = rate_hz, .delay = std::chrono::nanoseconds(0), .tap = {}},
                       open_patient_take_sound(take));
    for (const std::optional<TaiTime>& time :
         even_times(pictures, rate_hz, take->facts().pulse_rate_hz))
        blocks.push_back(sound.next({TaiTime(), time}));
    return blocks;
}

}  // namespace vantage
