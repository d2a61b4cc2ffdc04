#include "host_app/session/options/show_options.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <numbers>

#include <fmt/ranges.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/time/pulse_grid.h"
#include "host_app/background/background_file.h"
#include "host_app/control/ports/tracking_sinks.h"
#include "host_app/output/media/picture_encoder.h"

namespace vantage {
namespace {

/// Checks that an image can be saved to the path, before the flight whose result it is. Throws
/// Error for a wrong extension, for a folder that is missing or not writable, and for an existing
/// file that may not be replaced.
void require_picture_target(const std::filesystem::path& path, bool may_replace) {
    const std::string extension = path.extension().string();
    if (extension != ".png" && extension != ".jpg")
        fail("cannot write {}: a picture is a .png or .jpg file, not '{}'", path.string(),
             extension);
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        fail("cannot write {}: it is a folder", path.string());
    if (!may_replace && std::filesystem::exists(path, ignored))
        fail(
            "{} is there already, and a picture is not replaced without being asked: take another "
            "name, or --overwrite",
            path.string());
    const std::filesystem::path folder =
        path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    if (access(folder.c_str(), W_OK) != 0)
        fail("cannot write {}: its folder: {}", path.string(), std::strerror(errno));
}

OrbitView start_view(const StageConfig::View& view) {
    constexpr double rad = std::numbers::pi / 180;
    OrbitView start;
    start.pivot_m = {view.target_m[0], view.target_m[1], view.target_m[2]};
    start.azimuth_rad = view.azimuth_deg * rad;
    start.elevation_rad = view.elevation_deg * rad;
    start.distance_m = view.distance_m;
    start.field_of_view_rad = view.field_of_view_deg * rad;
    return start;
}

}  // namespace

LiveSettings ShowOptions::settings(const StageConfig::View& view, double pulse_rate_hz) const {
    LiveSettings settings{
        .format = {.width_px = view.width_px,
                   .height_px = view.height_px,
                   .stereoscopy = stereoscopic.stereoscopy()},
        .rate_hz = PulseGrid(rate.empty() ? pulse_rate_hz : parse_rate(rate)).rate_hz(),
        .pulse_rate_hz = pulse_rate_hz,
        .synthesiser = synthesiser.empty() ? view.synthesiser : synthesiser,
        .quality = QualityRequest::parse(quality),
        .source_map = source_map,
        .outputs = {},
        .encoder = encoder,
        .overwrites = overwrite,
        .contact_sheet = contact_sheet,
        .free_flight = free_flight,
        .compensate_gains = compensate_gains};
    if (!background.empty())
        settings.background = std::make_shared<const Background>(load_background(background));
    if (!size.empty()) {
        const cv::Size wanted = parse_size(size);
        settings.format.width_px = wanted.width;
        settings.format.height_px = wanted.height;
    }
    for (const std::string& url : outputs)
        if (!make_tracking_sink(url, settings.rate_hz, settings.pulse_rate_hz))
            settings.outputs.push_back(url);
    if (!film.empty()) settings.outputs.insert(settings.outputs.begin(), "file:" + film);
    OutputSupervisor::check(output_settings(settings));
    (void)find_synthesiser(settings.synthesiser);
    return settings;
}

std::shared_ptr<PictureSound> ShowOptions::sound(double rate_hz, const SoundTap& tap,
                                                 std::shared_ptr<SoundSource> source) const {
    if (!audio.empty()) source = open_sound(audio, tap);
    if (!source) {
        if (audio_delay_ms)
            fail(
                "--audio-delay has no effect without sound; add --audio, or play a take with "
                "sound");
        return nullptr;
    }
    PictureSound::Settings settings{.rate_hz = rate_hz, .tap = tap};
    if (audio_delay_ms) settings.delay = from_s(*audio_delay_ms / 1000);
    return std::make_shared<PictureSound>(settings, std::move(source));
}

FlightStore ShowOptions::flight_store(const std::string& beside) const {
    return FlightStore(flight.empty() ? flight_file_of(beside) : std::filesystem::path(flight));
}

ClipStore ShowOptions::clip_store(const std::string& beside, double pulse_rate_hz) const {
    return {clips.empty() ? clip_file_of(beside) : std::filesystem::path(clips), pulse_rate_hz};
}

std::optional<DeskStore> ShowOptions::desk_store(const std::string& beside) const {
    if (headless) return std::nullopt;
    return DeskStore(desk.empty() ? desk_file_of(beside) : std::filesystem::path(desk));
}

FlightPlan ShowOptions::plan(const StageConfig::View& view, FlightStore& flights) const {
    FlightPlan plan;
    plan.book = flights.book();
    if (view.is_placed) plan.start = start_view(view);
    if (!path.empty()) {
        FlightBook asked = load_flight(path);
        plan.move = std::move(asked.move);
        if (plan.move) flights.begin_with_another_move();
        for (std::size_t i = 0; i < asked.shots.size(); ++i)
            if (asked.shots[i]) plan.book.shots[i] = std::move(asked.shots[i]);
    }
    if (frames > 0) plan.frames = frames;
    if (seconds > 0) plan.seconds = seconds;
    for (const std::string& picture : {snapshot, contact_sheet})
        if (!picture.empty()) require_picture_target(picture, overwrite);
    return plan;
}

std::unique_ptr<TraceFile> ShowOptions::make_trace(const std::string& program) const {
    return trace.empty() ? nullptr : std::make_unique<TraceFile>(trace, program, overwrite);
}

std::unique_ptr<JogDevices> ShowOptions::make_deck() const {
    if (!jog.value_or(!headless)) return nullptr;
    return std::make_unique<JogDevices>(make_system_jog_bus(), load_all_wheel_profiles(wheels));
}

void ShowOptions::add_to(CLI::App& command, const std::string& owner) {
    namespace group = option_group;
    command
        .add_option(
            "--audio", audio,
            "Play the sound of SOURCE with the programme (docs/operate/sound.md): alsa:DEVICE "
            "(?channels=3,4) or a file (?loop=yes)")
        ->type_name("SOURCE")
        ->group(group::input);
    command
        .add_option("--audio-delay", audio_delay_ms,
                    "Delay the sound by this many milliseconds (default: the measured latency of "
                    "the picture; 0 for a file)")
        ->check(CLI::Range(0.0, 10'000.0))
        ->group(group::input);
    accept_old_name(command,
                    command
                        .add_option("--background", background,
                                    "Start with this background file (.vset); rigs with another "
                                    "calibration learn their background anew")
                        ->group(group::input),
                    "--set");  // old name

    command.add_option("--path", path, "Load shots from this flight file (TOML) and play its move")
        ->group(group::camera);
    command
        .add_option("--flight", flight,
                    "Keep shots and the move in this flight file (default: NAME.flight.toml beside "
                    "the stage or the take)")
        ->group(group::camera);
    command
        .add_flag("--free-flight", free_flight,
                  "Allow the camera to leave the area the rigs cover; without this it slows down "
                  "and stops at the edge")
        ->group(group::camera);

    command
        .add_option(
            "--rate", rate,
            "Set the frame rate, such as 50, 29.97 or 30000/1001 (default: " + owner + " rate)")
        ->group(group::picture);
    command
        .add_option("--size", size,
                    "Set the size of the picture, WIDTHxHEIGHT (default: " + owner + " size)")
        ->group(group::picture);
    command
        .add_option("--synth", synthesiser,
                    "Select the synthesiser (default: " + owner + "; see vantage render --help)")
        ->type_name(synthesisers_type_name())
        ->group(group::expert);
    command
        .add_option("--quality", quality,
                    "Set the quality: auto (the best that keeps the frame rate), best, or a level "
                    "from 0 (the best) on")
        ->capture_default_str()
        ->group(group::expert);
    accept_old_name(
        command,
        command
            .add_flag_callback(
                "--no-gain-compensation", [this] { compensate_gains = false; },
                "Do not correct differences in gain between the rigs; without this, small gains "
                "remove them slowly where rigs see the same surface")
            ->group(group::expert),
        "--no-harmonise");  // old name
    accept_old_name(command,
                    command
                        .add_flag("--source-map", source_map,
                                  "Show which rig each pixel comes from, one colour per rig, "
                                  "inpainted pixels hatched (key N); on screen and in snapshots, "
                                  "never in films")
                        ->group(group::picture),
                    "--novelty");  // old name

    std::string kinds;
    for (const OutputEntry& entry : output_entries()) kinds += "\n  " + entry.words;
    kinds += "\n  freed://HOST:PORT (the camera of every tick as FreeD D1; ?camera=1)";
    kinds +=
        "\n  opentrackio://HOST:PORT or opentrackio://multicast (the camera of every tick; "
        "?source=1, format=json or cbor, sensor-mm=36)";
    command
        .add_option("--output", outputs,
                    "Send the programme to URL at a constant frame rate, without overlays; repeat "
                    "the option for more outputs:" +
                        kinds)
        ->type_name("URL")
        ->allow_extra_args(false)
        ->group(group::output);
    command.add_option("--trace", trace, trace_help)->type_name("FILE")->group(group::expert);
    command
        .add_option("--encoder", encoder,
                    fmt::format("Encode with one of {} (default: the first that works; the log "
                                "names it)",
                                fmt::join(known_encoders(), ", ")))
        ->group(group::expert);
    command
        .add_option("--snapshot", snapshot,
                    "Write the last picture to this file (.png, .jpg); with a window, the whole "
                    "desk")
        ->group(group::output);
    command
        .add_option("--contact-sheet", contact_sheet,
                    "Write stills of the flight, with colour and disparity of a rig, to this file")
        ->group(group::output);
    command.add_flag("--overwrite", overwrite, "Replace films, pictures and traces that exist")
        ->group(group::output);
    command.add_flag("--json", json, "Print the summary as one JSON object")->group(group::output);

    std::string ports;
    for (const PortEntry& entry : port_entries()) ports += "\n  " + entry.words;
    command
        .add_option(
            "--control", controls,
            "Accept remote control on URL (docs/operate/control.md; vantage control lists the "
            "commands); only from this computer without open=yes; repeat the option for "
            "more ports:" +
                ports)
        ->type_name("URL")
        ->allow_extra_args(false)
        ->group(group::control);
    command
        .add_option("--metrics", metrics,
                    "Serve Prometheus metrics on URL, at http://HOST:PORT/metrics (:9464 listens "
                    "on 127.0.0.1; ?open=yes)")
        ->type_name("URL")
        ->group(group::control);
    command
        .add_option("--web", web,
                    "Serve a page for tablets and phones on URL, http://HOST:PORT or https://...: "
                    "the programme, its state and the rigs (?control=yes lets it give commands; "
                    "pin=DIGITS, pin-file=FILE, certificate=FILE and key=FILE, open=yes; "
                    "board=COLUMNSxROWS or board=FILE shows a technician the calibration board)")
        ->type_name("URL")
        ->group(group::control);
    command.add_flag("--headless", headless, "Run without a window")->group(group::control);
    command
        .add_option("--desk", desk,
                    "Keep the arrangement of the desk in this file (default: NAME.desk.toml beside "
                    "the stage or the take)")
        ->group(group::control);
    command
        .add_option("--clips", clips,
                    "Keep clips and play list in this file (default: NAME.clips.toml beside the "
                    "stage or the take)")
        ->group(group::control);
    command
        .add_flag_callback(
            "--jog", [this] { jog = true; },
            "Use jog wheels without a window too; with a window they are always used")
        ->group(group::control);
    command
        .add_flag_callback(
            "--no-jog", [this] { jog = false; }, "Ignore jog wheels")
        ->group(group::control);
    command
        .add_option("--wheels", wheels,
                    fmt::format("Load the maps of jog wheels from {}", wheel_files_help))
        ->group(group::expert);

    command
        .add_option("--record", film,
                    "Record the programme to this film (.mkv, .mp4) with time code; the same as "
                    "--output with a file")
        ->group(group::recording);
    accept_old_name(command,
                    command
                        .add_option("--save-background", saved_background,
                                    "Save the learnt background to this file at the end, or with "
                                    "the key J; without this option the key names the file by the "
                                    "time")
                        ->group(group::recording),
                    "--save-set");  // old name
    command
        .add_option("--frames", frames,
                    "End after this many frames (default without a window: at the end of a move "
                    "that does not loop)")
        ->check(CLI::PositiveNumber)
        ->group(group::recording);
    command.add_option("--seconds", seconds, "End after this many seconds")
        ->check(CLI::Range(0.01, 1e6))
        ->group(group::recording);

    stereoscopic.add_to(command, "the camera's distance from its pivot", group::stereoscopic);
}

}  // namespace vantage
