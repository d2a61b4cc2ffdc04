#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/base/cli/command.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/time/time_zone.h"
#include "common/base/time/timecode.h"
#include "common/take/take_check.h"
#include "common/take/take_edit.h"
#include "common/take/take_pulses.h"
#include "host_app/exports/edit_list.h"
#include "host_app/exports/take_export.h"
#include "host_app/replay/clip.h"
#include "host_app/session/options/common_options.h"
#include "host_app/session/options/film_options.h"
#include "host_app/takes/take_show.h"

namespace vantage {
namespace {

struct TakeOptions {
    std::string take, from, to, output, form;
    std::uint64_t every = 1;
    std::vector<std::string> takes;
    std::string clips;
    std::vector<std::string> media;
    bool from_zero = false;
    FilmOptions film;
    bool json = false;
};

/// Uses the time zone of the take for time codes.
void use_zone_of(const TakeReader& take) {
    const std::string zone = take_show_from(take.facts().show).timecode_zone;
    if (!zone.empty() && is_time_zone(zone)) use_time_zone(zone);
}

std::string codec_text(const TakePictures& pictures) {
    switch (pictures.codec) {
        case TakePictures::Codec::none:
            break;
        case TakePictures::Codec::jpeg:
            return fmt::format("JPEG {}x{}", pictures.size_px.width, pictures.size_px.height);
        case TakePictures::Codec::ffv1:
            return fmt::format("FFV1 {}x{}", pictures.size_px.width, pictures.size_px.height);
    }
    return "none";
}

std::uint64_t missing_of(const std::vector<TakeReader::Frame>& frames) {
    return frames.empty() ? 0 : frames.back().pulse - frames.front().pulse + 1 - frames.size();
}

double sound_s(const TakeReader& take) {
    std::int64_t samples = 0;
    for (const TakeReader::Sound& sound : take.sounds()) samples += sound.count;
    return static_cast<double>(samples) / sound_rate_hz;
}

nlohmann::ordered_json info_json(const TakeReader& take) {
    const TakeFacts& facts = take.facts();
    nlohmann::ordered_json json{{"path", take.path().string()},
                                {"program", facts.program},
                                {"timecode", facts.timecode},
                                {"pulse_rate_hz", facts.pulse_rate_hz},
                                {"duration_s", take.duration_s()},
                                {"bytes", take.bytes()},
                                {"ended", take.is_ended()},
                                {"damaged_places", take.damage().size()},
                                {"camera_ticks", take.cameras().size()}};
    if (facts.has_sound) json["sound_s"] = sound_s(take);
    json["rigs"] = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < facts.rigs.size(); ++i) {
        const std::vector<TakeReader::Frame>& frames = take.frames(i);
        nlohmann::ordered_json rig{{"name", facts.rigs[i].name},
                                   {"colour", codec_text(facts.rigs[i].colour)},
                                   {"disparity", codec_text(facts.rigs[i].depth)},
                                   {"frames", frames.size()},
                                   {"missing", missing_of(frames)}};
        if (!frames.empty()) {
            rig["first_pulse"] = frames.front().pulse;
            rig["last_pulse"] = frames.back().pulse;
            rig["left_out_by_host"] = frames.back().dropped;
        }
        json["rigs"].push_back(std::move(rig));
    }
    for (const TakeAttachment& attachment : facts.attachments)
        json["attachments"].push_back(attachment.name);
    return json;
}

void info(const TakeOptions& options) {
    const TakeReader take(options.take);
    const nlohmann::ordered_json json = info_json(take);
    if (options.json) {
        std::cout << json.dump() << '\n';
        return;
    }
    std::cout << fmt::format(
        "{}: {:.1f} s from {}, {:g} pulses per second, {:.1f} MB, written by {}\n",
        take.path().string(), take.duration_s(), take.facts().timecode, take.facts().pulse_rate_hz,
        static_cast<double>(take.bytes()) / 1e6, take.facts().program);
    for (const auto& rig : json["rigs"])
        std::cout << fmt::format(
            "{}: {} frames, {} missing; colour {}, disparity {}\n", rig["name"].get<std::string>(),
            rig["frames"].get<std::uint64_t>(), rig["missing"].get<std::uint64_t>(),
            rig["colour"].get<std::string>(), rig["disparity"].get<std::string>());
    std::cout << fmt::format("camera: {} ticks\n", take.cameras().size());
    if (take.facts().has_sound)
        std::cout << fmt::format("sound: {:.1f} s, PCM of 24 bits\n", sound_s(take));
    for (const TakeAttachment& attachment : take.facts().attachments)
        std::cout << fmt::format("attached: {}, {} bytes\n", attachment.name,
                                 attachment.bytes.size());
    if (!take.is_ended())
        std::cout << "the recording was interrupted; everything before that is readable\n";
    if (!take.damage().empty())
        std::cout << fmt::format("{} places are damaged; vantage take check lists them\n",
                                 take.damage().size());
}

/// Logs the progress at every 10 %.
std::function<void(double)> progress_of(const std::string& what) {
    return [what, logged = 0](double share) mutable {
        const auto tenth = static_cast<int>(10 * share);
        if (tenth <= logged) return;
        logged = tenth;
        log_info("{}: {} %", what, 10 * tenth);
    };
}

void check(const TakeOptions& options) {
    const TakeReader take(options.take);
    use_zone_of(take);
    const TakeVerdict verdict = check_take(take, progress_of(options.take));
    const TimecodeClock clock(take.facts().pulse_rate_hz);
    const int tai_offset_s = take.facts().tai_offset_s;
    const auto code = [&](std::uint64_t pulse) { return clock.of_pulse(pulse, tai_offset_s); };
    std::uint64_t missing = 0;
    for (const TakeGap& gap : verdict.gaps) missing += gap.pulses();
    if (options.json) {
        nlohmann::ordered_json json{{"path", options.take},
                                    {"whole", verdict.is_whole()},
                                    {"ended", take.is_ended()},
                                    {"frames", verdict.frames},
                                    {"missing", missing}};
        json["gaps"] = json["damage"] = nlohmann::ordered_json::array();
        for (const TakeGap& gap : verdict.gaps)
            json["gaps"].push_back({{"rig", gap.rig},
                                    {"from_pulse", gap.from},
                                    {"to_pulse", gap.to},
                                    {"from", code(gap.from)},
                                    {"why", gap.why}});
        if (take.facts().has_sound) {
            json["sound_s"] = verdict.sound_s;
            json["sound_gaps"] = nlohmann::ordered_json::array();
            for (const SoundGap& gap : verdict.sound_gaps)
                json["sound_gaps"].push_back({{"from_tai_ns", to_ns(gap.from)},
                                              {"from", clock.at(gap.from, tai_offset_s)},
                                              {"seconds", gap.seconds}});
        }
        for (const TakeDamage& damage : verdict.damage)
            json["damage"].push_back({{"at_byte", damage.at}, {"what", damage.words}});
        std::cout << json.dump() << '\n';
    } else {
        for (const TakeGap& gap : verdict.gaps)
            std::cout << fmt::format("{}: {} pulse{} missing from {} (pulse {}){}{}\n", gap.rig,
                                     gap.pulses(), gap.pulses() == 1 ? "" : "s", code(gap.from),
                                     gap.from, gap.why.empty() ? "" : ": ", gap.why);
        for (const SoundGap& gap : verdict.sound_gaps)
            std::cout << fmt::format("sound: {:.3f} s missing from {}\n", gap.seconds,
                                     clock.at(gap.from, tai_offset_s));
        for (const TakeDamage& damage : verdict.damage)
            std::cout << fmt::format("byte {}: {}\n", damage.at, damage.words);
        std::cout << fmt::format("{} frames are intact\n", verdict.frames);
        if (take.facts().has_sound)
            std::cout << fmt::format("{:.1f} s of sound are intact\n", verdict.sound_s);
    }
    if (!verdict.is_whole())
        fail("{} is not complete: {} frames are missing in {} gaps, {} places are damaged{}",
             options.take, missing, verdict.gaps.size(), verdict.damage.size(),
             verdict.sound_gaps.empty()
                 ? ""
                 : fmt::format(", and its sound has {} gaps", verdict.sound_gaps.size()));
}

void print_copy(const TakeCopy& copy, const TakeOptions& options) {
    if (options.json)
        std::cout << nlohmann::ordered_json{{"path", options.output},
                                            {"frames", copy.frames},
                                            {"camera_ticks", copy.cameras},
                                            {"damaged", copy.damaged},
                                            {"twice", copy.twice},
                                            {"sound_s", copy.sound_s}}
                         .dump()
                  << '\n';
    else
        std::cout << fmt::format(
            "{}: {} frames{}{}\n", options.output, copy.frames,
            copy.damaged > 0 ? fmt::format(", {} damaged frames left out", copy.damaged) : "",
            copy.twice > 0 ? fmt::format(", {} duplicates left out", copy.twice) : "");
}

/// Returns the part of the take between --from and --to.
TakePart part_of(const TakeReader& take, const TakeOptions& options) {
    const PulseSpan span = pulse_span_of(take);
    TakePart part;
    part.from =
        options.from.empty() ? span.first : pulse_of(take, options.from, span.first, span.last);
    part.to =
        options.to.empty() ? span.last + 1 : pulse_of(take, options.to, span.first, span.last);
    part.every = options.every;
    if (part.from > span.last)
        fail("--from {} is after the end of {}, which is {:.1f} s long", options.from, options.take,
             take.duration_s());
    if (part.from >= part.to)
        fail("--from {} is not before --to {}", options.from.empty() ? "0" : options.from,
             options.to);
    return part;
}

void cut(const TakeOptions& options) {
    const TakeReader take(options.take);
    use_zone_of(take);
    const TakePart part = part_of(take, options);
    print_copy(copy_takes({&take}, part.from, part.to, options.output, progress_of(options.output)),
               options);
}

/// Returns the clips of --clips, or of the file beside the take; without one there are no clips.
ClipBook clips_of(const TakeReader& take, const TakeOptions& options) {
    const std::filesystem::path file =
        options.clips.empty() ? clip_file_of(take.path()) : std::filesystem::path(options.clips);
    if (options.clips.empty() && !std::filesystem::exists(file)) {
        log_info("{} has no clips: the edit list has the whole material", options.take);
        return {};
    }
    return load_clips(file, take.facts().pulse_rate_hz);
}

void export_edit_list(const TakeOptions& options) {
    FilmOptions others = options.film;
    others.rate.clear();
    if (others.is_any() || !options.from.empty() || !options.to.empty() || options.every != 1)
        fail("--as {} takes --clips, --media, --from-zero and --rate only", options.form);
    if (options.from_zero && options.form == "edl")
        fail("--from-zero applies only to --as otio: an EDL refers to films by their time code");
    if (std::filesystem::exists(options.output))
        fail("{} already exists; choose another name for the edit list", options.output);
    const TakeReader take(options.take);
    use_zone_of(take);
    std::vector<EditFilm> films;
    for (const std::string& film : options.media) films.push_back(read_edit_film(film));
    std::optional<double> rate_hz;
    if (!options.film.rate.empty()) rate_hz = parse_rate(options.film.rate);
    EditList list = make_edit_list(take, clips_of(take, options), films, rate_hz);
    if (options.from_zero) count_films_from_zero(list);
    if (options.form == "edl")
        write_edl(list, options.output);
    else
        write_otio(list, options.output);
    if (options.json)
        std::cout << nlohmann::ordered_json{{"path", options.output},
                                            {"as", options.form},
                                            {"events", list.events.size()},
                                            {"offline", list.offline},
                                            {"rate_hz", list.rate_hz}}
                         .dump()
                  << '\n';
    else
        std::cout << fmt::format(
            "{}: {} events at {:.5g} fps{}\n", options.output, list.events.size(), list.rate_hz,
            list.offline > 0 ? fmt::format(", {} without a film", list.offline) : "");
}

/// Describes what an export has written, such as "3 instants, 12 existed already".
std::string sentence_of(const ExportStats& stats, std::string_view things) {
    std::string sentence =
        stats.written == 0 && stats.there > 0
            ? fmt::format("all {} {} existed already, nothing was written", stats.there, things)
            : fmt::format("{} {}", stats.written, things);
    if (stats.written > 0 && stats.there > 0)
        sentence += fmt::format(", {} existed already", stats.there);
    if (stats.damaged > 0) sentence += fmt::format(", {} damaged frames left out", stats.damaged);
    return sentence;
}

void export_take(const TakeOptions& options) {
    if (options.form == "otio" || options.form == "edl") return export_edit_list(options);
    if (!options.clips.empty() || !options.media.empty() || options.from_zero)
        fail("--clips, --media and --from-zero apply only to --as otio and --as edl");
    const bool is_film = options.form == "film";
    const ExportFormat* format =
        options.form == "camera" || is_film ? nullptr : &find_export_format(options.form);
    if (!is_film && options.film.is_any())
        fail("--path, --rate, --size, --synth and --stereoscopic apply only to --as film");
    if (is_film && options.every != 1) fail("--every does not apply to a film; use --rate");
    const TakeReader take(options.take);
    use_zone_of(take);
    const TakePart part = part_of(take, options);
    const ExportStats stats =
        is_film
            ? options.film.write(options.take, part, !options.from.empty() || !options.to.empty(),
                                 options.output, progress_of(options.output))
        : format ? export_moments(take, *format, part, options.output, progress_of(options.output))
                 : export_camera(take, part, options.output);
    if (options.json)
        std::cout << nlohmann::ordered_json{{"path", options.output},
                                            {"as", options.form},
                                            {"written", stats.written},
                                            {"there", stats.there},
                                            {"damaged", stats.damaged}}
                         .dump()
                  << '\n';
    else
        std::cout << fmt::format("{}: {}\n", options.output,
                                 sentence_of(stats, is_film  ? "frames"
                                                    : format ? "instants"
                                                             : "ticks of the camera"));
}

void serve(const TakeOptions& options) {
    const TakeReader take(options.take);
    use_zone_of(take);
    serve_take(take, std::cin, std::cout);
}

void join(const TakeOptions& options) {
    std::vector<std::unique_ptr<TakeReader>> readers;
    std::vector<const TakeReader*> takes;
    for (const std::string& take : options.takes) {
        readers.push_back(std::make_unique<TakeReader>(take));
        takes.push_back(readers.back().get());
    }
    use_zone_of(*takes.front());
    print_copy(copy_takes(takes, 0, ~std::uint64_t{0}, options.output, progress_of(options.output)),
               options);
}

}  // namespace

CommandEntry take_command_entry() {
    return {[](CLI::App& program) {
        auto options = std::make_shared<TakeOptions>();
        CLI::App* take =
            program.add_subcommand("take", "Inspect, cut, join and export takes of rigs' frames");
        take->require_subcommand(1);
        const auto add = [&](const char* name, const char* words,
                             void (*work)(const TakeOptions&)) {
            CLI::App* command = take->add_subcommand(name, words);
            command->add_flag("--json", options->json, "Print the result as JSON");
            command->callback([options, work] { work(*options); });
            return command;
        };
        const auto add_take = [&](CLI::App* command) {
            command->add_option("TAKE", options->take, "Take (.mkv)")->required();
        };
        add_take(add("info", "Print the contents of a take", info));
        add_take(add("check",
                     "Read every byte of a take and list gaps and damage; exit with 1 if there is "
                     "any",
                     check));
        CLI::App* serve_command =
            take->add_subcommand("serve",
                                 "Serve decoded frame sets to another program by standard input "
                                 "and output; the Python module vantage uses it");
        serve_command->callback([options] { serve(*options); });
        add_take(serve_command);
        CLI::App* cut_command =
            add("cut", "Copy a part of a take to a new one, without encoding again", cut);
        add_take(cut_command);
        const auto add_part = [&](CLI::App* command) {
            command->add_option("--from", options->from,
                                "Start at this time: seconds after the beginning, or time code "
                                "(default: the beginning)");
            command->add_option("--to", options->to,
                                "End at this time, which is not included, likewise (default: the "
                                "end)");
        };
        add_part(cut_command);
        cut_command->add_option("-o,--output", options->output, "Write this take (.mkv)")
            ->required();
        CLI::App* join_command = add(
            "join", "Join takes of one stage by pulse, of different rigs or different times", join);
        join_command->add_option("TAKES", options->takes, "Takes (.mkv)")
            ->required()
            ->expected(1, 1000);
        join_command->add_option("-o,--output", options->output, "Write this take (.mkv)")
            ->required();
        CLI::App* export_command =
            add("export", "Export a take for other programs; an interrupted export is resumed",
                export_take);
        add_take(export_command);
        std::string forms =
            "Export as camera: the flight as CSV and FreeD; film: a flight over the take (.mkv, "
            ".mp4), every frame at the best quality, slower than real time; otio, edl: play list "
            "and clips "
            "for editors, as an OpenTimelineIO timeline or a CMX 3600 EDL";
        for (const ExportFormat& format : export_formats())
            forms += fmt::format("; {}: {}", format.name, format.words);
        export_command->add_option("--as", options->form, forms)->required();
        add_part(export_command);
        export_command
            ->add_option("--every", options->every,
                         "Export only every Nth pulse, or tick of the camera")
            ->check(CLI::Range(1, 1'000'000))
            ->capture_default_str();
        export_command->add_option("-o,--output", options->output, "Write to this folder or file")
            ->required();
        export_command
            ->add_option("--clips", options->clips,
                         "Clips and play list of an edit list (default: TAKE.clips.toml)")
            ->group("Edit list");
        export_command
            ->add_option("--media", options->media,
                         "Refer to these films of the take at normal speed (.mkv, .mp4); an event "
                         "takes the first that has its frames (default: offline)")
            ->expected(1, 100)
            ->group("Edit list");
        export_command
            ->add_flag("--from-zero", options->from_zero,
                       "Count the frames of each film from 0, for editors that ignore the time "
                       "code at which a film starts (otio only)")
            ->group("Edit list");
        options->film.add_to(*export_command);
    }};
}

}  // namespace vantage
