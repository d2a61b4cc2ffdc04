#include <filesystem>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "calib_tools/commands/live_option.h"
#include "calib_tools/commands/rig_folders.h"
#include "calib_tools/report/calibration_text.h"
#include "calib_tools/sync/stage_sync.h"
#include "common/base/cli/command.h"
#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/log.h"
#include "common/base/time/time.h"
#include "common/config/stage_config.h"
#include "common/image/image_file.h"
#include "common/image/picture_list.h"
#include "common/sync/sync_file.h"

namespace vantage {
namespace {

/// Fast enough to see a bar with a period of some tenths of a second at all its phases soon.
constexpr double pictures_per_second = 5;

struct SyncOptions {
    std::vector<std::string> rigs;
    LiveOption live;
    std::string stage;
    int leds = 12;
    double step_us = 127, limit_ms = 0.5;
    std::filesystem::path output, screen;
    bool json = false;
};

/// Frames of one sensor.
struct Film {
    std::string rig;
    bool is_left = true;
    BarFilm seen;

    Film(std::string rig_name, bool left) : rig(std::move(rig_name)), is_left(left) {
        seen.sensor = SensorSkew{.rig = rig, .is_left = is_left}.name();
    }
};

std::vector<Film> film_live(const SyncOptions& options, std::vector<RigFolder> rigs) {
    if (rigs.empty())
        for (const StageConfig::Rig& rig : load_stage_config(options.live.stage_file).rigs)
            rigs.push_back({rig.name, {}});
    std::vector<Film> films;
    for (const RigFolder& rig : rigs)
        for (const bool is_left : {true, false}) films.emplace_back(rig.name, is_left);
    LiveRigs stage = options.live.connect(rigs, pictures_per_second);
    log_info("filming the bar: {} instants", options.live.views);
    for (int i = 0; i < options.live.views; ++i) {
        const std::optional<LiveInstant> instant = stage.next_complete();
        if (!instant) break;
        for (std::size_t c = 0; c < films.size(); ++c) {
            const RawPair& pair = *instant->pairs[c / 2];
            films[c].seen.pulses.push_back(instant->pulse);
            films[c].seen.pictures.push_back(
                brightest_channel(films[c].is_left ? pair.left : pair.right));
        }
    }
    return films;
}

Film read_film(const RigFolder& rig, bool is_left) {
    const std::string pattern = (rig.folder / (is_left ? "left*" : "right*")).string();
    const std::vector<std::filesystem::path> files = expand_pictures(pattern);
    const std::vector<long long> numbers = picture_numbers(files);
    if (numbers.empty())
        fail(
            "{}: the pictures have no numbers in their names that tell their pulses "
            "(left_PULSE.png, as vantage-rig capture writes them)",
            pattern);
    Film film(rig.name, is_left);
    film.seen.pulses.assign(numbers.begin(), numbers.end());
    for (const std::filesystem::path& file : files)
        film.seen.pictures.push_back(brightest_channel(read_colour_image(file)));
    return film;
}

SyncRecord prove(const std::vector<Film>& films, const SyncBar& bar, double rate_hz) {
    std::vector<SensorFilm> read;
    for (const Film& film : films) {
        read.push_back(
            {film.rig, film.is_left, film.seen.pulses, read_bar(film.seen, bar, rate_hz)});
        const SensorExposures& seen = read.back().seen;
        log_info(
            "{}: exposures of {:.3f} ms in {} of {} pictures, by {} LEDs; {:.1f} % of an LED's "
            "light is not explained; pictures are {}",
            film.seen.sensor, seen.fit.length_ms, seen.fit.used, film.seen.pictures.size(),
            seen.leds_seen, 100 * seen.fit.misfit, seen.transfer);
        if (seen.misses_phases)
            log_warning(
                "{}: the bar's steps of {:g} us divide the time between the pictures, which show "
                "few of its phases: let it count at another step (127 us fits no usual rate)",
                film.seen.sensor, to_us(bar.step()));
    }
    SyncRecord record;
    record.date = date_now();
    record.tool = "vantage-calib sync";
    record.rate_hz = rate_hz;
    record.bar_step_ms = to_ms(bar.step());
    record.sensors = skews_of(read, bar, rate_hz);
    record.reference = record.sensors.front().name();
    return record;
}

void run(const SyncOptions& options) {
    if (!options.screen.empty()) {
        write_text_atomically(options.screen, screen_pages().front().text);
        log_info("{} written: open it in a browser, full screen", options.screen.string());
        return;
    }
    const std::string& stage_file = options.live.given() ? options.live.stage_file : options.stage;
    if (stage_file.empty())
        fail("of which stage? give --live stage.toml, or --stage stage.toml with pictures of it");
    const std::vector<RigFolder> rigs = parse_rig_folders(options.rigs);
    if (rigs.empty() && !options.live.given())
        fail("which pictures? give --rig NAME=FOLDER for each rig, or --live stage.toml");
    const SyncBar bar(options.leds, from_us(options.step_us));
    const double rate_hz = load_stage_config(stage_file).rate_hz;
    std::vector<Film> films;
    if (options.live.given())
        films = film_live(options, rigs);
    else
        for (const RigFolder& rig : rigs)
            for (const bool is_left : {true, false}) films.push_back(read_film(rig, is_left));
    const SyncRecord record = prove(films, bar, rate_hz);
    const std::filesystem::path file =
        options.output.empty() ? sync_file_of(stage_file) : options.output;
    save_sync(file, record);
    log_info("{} written", file.string());
    const std::vector<std::string> troubles = sync_troubles(record, options.limit_ms);
    const std::vector<std::string> doubts = sync_doubts(record, options.limit_ms);
    if (options.json) {
        nlohmann::ordered_json json = to_json(record);
        json["troubles"] = troubles;
        json["doubts"] = doubts;
        std::cout << json.dump(2) << '\n';
    } else {
        std::cout << describe(record);
    }
    if (!troubles.empty()) fail("the stage is not in step: {}", fmt::join(troubles, "; "));
    if (!doubts.empty())
        throw Undecided(fmt::format("whether the stage is in step cannot be told: {}",
                                    fmt::join(doubts, "; ")));
}

}  // namespace

CommandEntry sync_command_entry() {
    return {[](CLI::App& program) {
        CLI::App* command =
            program.add_subcommand("sync",
                                   "Prove with pictures of a counting bar of LEDs that all sensors "
                                   "expose at the same time; exit with 0 if they do, 1 if they do "
                                   "not, 3 if the pictures show too little to decide");
        const auto options = std::make_shared<SyncOptions>();
        options->live.views = 24;
        command->add_option("--rig", options->rigs,
                            "Folder of a rig, given as NAME=FOLDER, with left_PULSE.png and "
                            "right_PULSE.png, raw pictures of the bar; with --live the name alone "
                            "(default: all rigs); repeat the option for each rig");
        options->live.add_to(*command);
        command->add_option(
            "--stage", options->stage,
            "Without --live: the stage file (stage.toml) of the stage that the pictures show");
        command->add_option("--leds", options->leds, "Set the number of LEDs of the bar")
            ->check(CLI::Range(SyncBar::least_leds, SyncBar::most_leds))
            ->capture_default_str();
        command
            ->add_option("--step-us", options->step_us,
                         "Set the time of one step of the bar in microseconds; for a page on a "
                         "screen, that of one refresh (16667 at 60 Hz)")
            ->check(CLI::Range(10.0, 1e6))
            ->capture_default_str();
        command
            ->add_option("--limit-ms", options->limit_ms,
                         "Accept a skew up to this many milliseconds")
            ->check(CLI::Range(0.001, 1e4))
            ->capture_default_str();
        command->add_option(
            "--screen", options->screen,
            "Write a page (HTML) that counts on a screen instead of a bar, and end");
        command->add_option(
            "-o,--output", options->output,
            "Write the result to this file (default: stage.sync.yaml beside stage.toml)");
        command->add_flag("--json", options->json, "Print the result as JSON");
        command->callback([options] { run(*options); });
    }};
}

}  // namespace vantage
