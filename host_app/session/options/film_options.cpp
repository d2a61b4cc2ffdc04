#include "host_app/session/options/film_options.h"

#include "common/base/cli/stop_signal.h"
#include "common/base/error.h"
#include "common/base/time/pulse_grid.h"
#include "host_app/flight/flight_plan.h"
#include "host_app/output/media/film_file.h"
#include "host_app/session/options/common_options.h"
#include "host_app/takes/take_show.h"

namespace vantage {

void FilmOptions::add_to(CLI::App& command) {
    constexpr const char* group = "Film";
    command
        .add_option("--path", path,
                    "Fly the move of this flight file (TOML) (default: the camera of the take)")
        ->group(group);
    command
        .add_option("--rate", rate,
                    "Set the frame rate, also of an edit list, such as 50, 29.97 or 30000/1001 "
                    "(default: the stage's rate, or that of --media)")
        ->group(group);
    command
        .add_option("--size", size,
                    "Set the size of the picture, WIDTHxHEIGHT (default: the stage's size)")
        ->group(group);
    command
        .add_option("--synth", synthesiser,
                    "Select the synthesiser (default: the stage's; see vantage render --help)")
        ->type_name(synthesisers_type_name())
        ->group(group);
    stereoscopic.add_to(command, "the camera's distance from its pivot", group);
}

bool FilmOptions::is_any() const {
    return !path.empty() || !rate.empty() || !size.empty() || !synthesiser.empty() ||
           stereoscopic.stereoscopy();
}

ExportStats FilmOptions::write(const std::filesystem::path& take_file, const TakePart& part,
                               bool has_part, const std::filesystem::path& file,
                               const std::function<void(double)>& progress) const {
    // It must exist before any other thread is started, so that it receives the signals.
    StopSignal stop;
    require_film_name(file);
    const auto take = std::make_shared<const TakeReader>(take_file);
    const TakeShow show = take_show_from(take->facts().show);
    const double rate_hz =
        PulseGrid(rate.empty() ? take->facts().pulse_rate_hz : parse_rate(rate)).rate_hz();
    std::vector<FilmPicture> pictures;
    if (path.empty()) {
        pictures = film_of_cameras(*take, part, rate_hz);
    } else {
        const Move move = Move::load(path);
        if (move.take_s_at(0) && has_part)
            fail("{} is tied to the take's time; leave out --from and --to", path);
        pictures = film_of(move, *take, part, rate_hz);
    }
    FilmSettings settings{{show.view.width_px, show.view.height_px, stereoscopic.stereoscopy()},
                          rate_hz,
                          synthesiser.empty() ? show.view.synthesiser : synthesiser};
    if (!size.empty()) {
        const cv::Size wanted = parse_size(size);
        settings.format.width_px = wanted.width;
        settings.format.height_px = wanted.height;
    }
    const auto is_wanted = [&] { return !stop.requested(); };
    const ExportStats stats = export_film(take, pictures, settings, file, is_wanted, progress);
    if (stats.written + stats.there < pictures.size())
        fail("{} is not complete: {} of {} frames are rendered; run the same command to continue",
             file.string(), stats.written + stats.there, pictures.size());
    return stats;
}

}  // namespace vantage
