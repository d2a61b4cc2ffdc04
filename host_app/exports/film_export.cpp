#include "host_app/exports/film_export.h"

#include <algorithm>
#include <cmath>

#include "common/base/error.h"
#include "common/gl/egl_context.h"
#include "common/gl/limits.h"
#include "common/take/take_pulses.h"
#include "host_app/exports/camera_files.h"
#include "host_app/instants/colour_harmoniser.h"
#include "host_app/instants/depth_views.h"
#include "host_app/output/set_timecode.h"
#include "host_app/output/video_writer.h"
#include "host_app/takes/take_sets.h"
#include "host_app/takes/take_show.h"

namespace vantage {
namespace {

/// Before the first picture: what is learnt along time needs some.
constexpr double learning_s = 5;
/// Instants further apart have nothing to say to each other.
constexpr double longest_gap_s = 1;
/// x264's constant rate factor of a film that is worked on further.
constexpr double film_quality = 16;
constexpr std::size_t most_pictures = 10'000'000;

std::size_t pictures_of(double duration_s, double rate_hz) {
    const double count = std::max(1.0, std::round(duration_s * rate_hz));
    if (count > most_pictures)
        fail("a film of {:.0f} s at {:g} pictures a second has too many of them: {} are the most",
             duration_s, rate_hz, most_pictures);
    return static_cast<std::size_t>(count);
}

/// Instants of a take, in the order in which they are asked for.
class FilmInstants {
  public:
    FilmInstants(std::shared_ptr<const TakeReader> take, const SynthesiserEntry& synthesiser,
                 const ShaderLibrary& shaders)
        : show_(take_show_from(take->facts().show)),
          rate_hz_(take->facts().pulse_rate_hz),
          sets_(std::move(take)),
          preparer_(synthesiser.make_preparer(shaders)) {}

    void go_to(double pulse, const VirtualView& target) {
        const std::uint64_t there = *sets_.pulse_at(pulse);
        if (set_ && set_->trigger_index == there) return;
        const double dt_s = set_ && there > set_->trigger_index
                                ? static_cast<double>(there - set_->trigger_index) / rate_hz_
                                : 2 * longest_gap_s;
        set_ = sets_.at(static_cast<double>(there));
        if (dt_s > longest_gap_s) preparer_->forget();
        std::vector<DepthView> views = depth_views_of(*set_, show_.colours);
        harmoniser_.see(views, std::min(dt_s, longest_gap_s));
        for (DepthView& view : views) harmoniser_.apply(view);
        preparer_->take(views, std::min(dt_s, longest_gap_s));
        for (std::size_t rig = 0; rig < views.size(); ++rig) preparer_->improve(target);
    }
    std::shared_ptr<const Instant> prepared(const VirtualView& target) {
        return preparer_->prepare(target, prepare_levels().front());
    }
    const FrameSet& set() const { return *set_; }
    const TakeSets& sets() const { return sets_; }

  private:
    TakeShow show_;
    double rate_hz_;
    TakeSets sets_;
    ColourHarmoniser harmoniser_;
    std::unique_ptr<InstantPreparer> preparer_;
    std::optional<FrameSet> set_;
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
    if (duration_s < 0) fail("{} has no frame in that part", take.path().string());
    std::vector<FilmPicture> pictures(pictures_of(duration_s, rate_hz));
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        const double time_s = static_cast<double>(i) / rate_hz;
        pictures[i].camera = move.at(time_s).camera();
        // A pulse's own time is its, whatever the last bit of a sum says.
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
        fail("{} has no camera in that part; say which flight with --path", take.path().string());
    // Ticks are even; when they were handed out is not.
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

ExportBooks export_film(std::shared_ptr<const TakeReader> take,
                        const std::vector<FilmPicture>& pictures, const FilmSettings& settings,
                        const std::filesystem::path& file, const std::function<bool()>& is_wanted,
                        const std::function<void(double)>& progress) {
    if (std::filesystem::exists(file))
        fail("{} is there already: give the film another name", file.string());
    const SynthesiserEntry synthesiser = find_synthesiser(settings.synthesiser);
    const PictureFormat& format = settings.format;
    VideoWriter film(file, {.width_px = format.width_px,
                            .height_px = format.height_px,
                            .rate_hz = settings.rate_hz,
                            .quality = film_quality});
    const EglContext context;
    GlInfo::query().require_vantage_minimum();
    const ShaderLibrary shaders;
    const double pulse_rate_hz = take->facts().pulse_rate_hz;
    const SetTimecode timecodes(pulse_rate_hz, settings.rate_hz);
    FilmInstants instants(std::move(take), synthesiser, shaders);
    ViewPainter painter(synthesiser, format, shaders);
    const auto view = [&](const FilmPicture& picture) {
        return view_of(picture.camera, {format.width_px, format.height_px});
    };
    const std::uint64_t first = *instants.sets().pulse_at(pictures.front().pulse);
    const auto learning = static_cast<std::uint64_t>(std::llround(learning_s * pulse_rate_hz));
    const std::uint64_t oldest = instants.sets().span()->oldest;
    for (std::uint64_t pulse = std::max(oldest, first - std::min(first, learning));
         pulse < first && is_wanted(); ++pulse)
        instants.go_to(static_cast<double>(pulse), view(pictures.front()));
    ExportBooks books;
    for (const FilmPicture& picture : pictures) {
        if (!is_wanted()) break;
        if (progress)
            progress(static_cast<double>(books.written) / static_cast<double>(pictures.size()));
        const VirtualView target = view(picture);
        instants.go_to(picture.pulse, target);
        const std::shared_ptr<const Instant> instant = instants.prepared(target);
        film.add(painter.paint(*instant, picture.camera, render_levels().front()),
                 static_cast<std::int64_t>(books.written), timecodes.of(instants.set()));
        ++books.written;
    }
    if (books.written == 0) fail("{} is not written: it was ended before", file.string());
    film.finish();
    return books;
}

}  // namespace vantage
