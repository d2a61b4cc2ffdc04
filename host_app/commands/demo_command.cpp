#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/base/child_log.h"
#include "common/base/child_process.h"
#include "common/base/cli/command.h"
#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/log.h"
#include "common/config/calibration_file.h"
#include "common/virtual_stage/performer.h"
#include "host_app/commands/demo/demo_stage.h"
#include "host_app/commands/live_session.h"

namespace vantage {
namespace {

struct DemoOptions {
    std::vector<std::string> files, rig;
    std::optional<int> disparities;
    std::optional<double> rate_hz;
    std::string folder = "vantage-demo", kept, trace;
    double seconds = 12;
    bool sweep = false, headless = false, rigs_only = false, json = false;

    bool films_the_stage() const { return files.empty() && rig.empty(); }
};

/// Limit of the output of a program that the demo runs.
constexpr std::size_t max_output_bytes = 1 << 20;

std::filesystem::path program_beside(const std::string& name) {
    std::filesystem::path program = program_folder() / name;
    if (!std::filesystem::exists(program))
        fail("the demo needs {} in {}; install the package {}", name, program_folder().string(),
             name);
    return program;
}

nlohmann::json ask_program(const std::filesystem::path& folder, const std::string& name,
                           const std::vector<std::string>& arguments) {
    const std::filesystem::path out = folder / "asked.json", err = folder / "asked.log";
    const int status =
        ChildProcess(
            {.program = program_beside(name), .arguments = arguments, .out = out, .err = err})
            .wait();
    if (status != 0) {
        const std::string said = last_sentence_of(err);
        // What another program ends with is a sentence for itself.
        if (!said.empty()) fail("{}", said);
        fail("{} {} failed with status {}", name, arguments.front(), status);
    }
    // Of the pictures that a person gave, such as their orientation; a rig's own log repeats them.
    if (const std::string& work = arguments.front(); work == "match" || work == "capture")
        for (const std::string& warning : warnings_in(err)) log_warning_once(warning, warning);
    nlohmann::json answer =
        nlohmann::json::parse(read_text_file(out, max_output_bytes), nullptr, false);
    if (answer.is_discarded()) fail("{} {} printed no JSON", name, arguments.front());
    return answer;
}

/// Returns the memory that the pairs of the stage's loop take in a rig, MB.
int loop_mb(const DemoSize& size) {
    constexpr double bytes_per_px = 2 * 3;
    const double pairs = std::ceil(static_cast<double>(stage_loop.count()) * size.rate_hz);
    return static_cast<int>(std::ceil(1e-6 * pairs * size.rig[0] * size.rig[1] * bytes_per_px));
}

/// Adds virtual rigs in an arc around the stage, from left to right.
void add_virtual_rigs(int count, const DemoSize& size, DemoStage& stage) {
    constexpr double apart_deg = 20;
    for (int number = 1; number <= count; ++number) {
        const double azimuth_deg = apart_deg * (number - 0.5 * (count + 1));
        toml::table match{{"preset", size.preset}, {"disparities", size.disparities}};
        if (size.match_width_px > 0) match.insert("width_px", size.match_width_px);
        toml::table rig{{"azimuth_deg", azimuth_deg}};
        if (size.is_software) {
            rig.insert("loop_ahead", true);
            rig.insert("loop_mb", loop_mb(size));
        }
        stage.add_rig(fmt::format("rig{}", number),
                      toml::table{{"source", toml::table{{"kind", "virtual"},
                                                         {"rate_hz", size.rate_hz},
                                                         {"width_px", size.rig[0]},
                                                         {"height_px", size.rig[1]},
                                                         {"noise_sigma", 1.0},
                                                         {"seed", number}}},
                                  {"virtual_rig", rig},
                                  {"match", match}});
    }
}

/// Measures the matching time of a rig of this size.
double match_ms_of(DemoSize size, const std::filesystem::path& folder, const AskProgram& ask) {
    log_info("measuring how fast this computer matches pictures of {}x{}", size.rig[0],
             size.rig[1]);
    // About a second. A software renderer must not render the whole loop for this.
    const int frames = std::exchange(size.is_software, false) ? 8 : 15;
    size.rate_hz = 25;
    DemoStage alone(folder, {});
    add_virtual_rigs(1, size, alone);
    const nlohmann::json run = ask("vantage-rig", {"run", "--config", alone.rig_file("rig1"),
                                                   "--frames", std::to_string(frames), "--json"});
    std::filesystem::remove_all(folder);
    return run.at("/match_ms/p50"_json_pointer).get<double>();
}

std::vector<std::unique_ptr<ChildProcess>> start_rigs(const DemoStage& stage, bool is_software) {
    // The rigs yield to the host, which has its own computer in a real stage. With a software
    // renderer one drawing thread per rig does the same work with less waiting.
    constexpr int niceness = 5;
    std::vector<std::string> environment;
    if (is_software) environment.emplace_back("LP_NUM_THREADS=1");
    std::vector<std::unique_ptr<ChildProcess>> rigs;
    for (const std::string& name : stage.rigs()) {
        const std::filesystem::path log = stage.folder() / (name + ".log");
        rigs.push_back(std::make_unique<ChildProcess>(
            ChildProcess::Settings{.program = program_beside("vantage-rig"),
                                   .arguments = {"run", "--config", stage.rig_file(name)},
                                   .err = log,
                                   .environment = environment,
                                   .niceness = niceness}));
    }
    return rigs;
}

/// Throws Error with the sentence that a rig's process ended with. A rig ends before its first
/// picture only for a fault.
void require_running(const std::vector<std::unique_ptr<ChildProcess>>& rigs,
                     const DemoStage& stage) {
    for (std::size_t i = 0; i < rigs.size(); ++i) {
        const std::optional<int> status = rigs[i]->ended();
        if (!status) continue;
        const std::string& name = stage.rigs()[i];
        const std::filesystem::path log = stage.folder() / (name + ".log");
        const std::string sentence = last_sentence_of(log);
        fail("the rig '{}' ended before its first picture: {}", name,
             sentence.empty() ? fmt::format("status {}, and {} says nothing", *status, log.string())
                              : sentence);
    }
}

/// Whether every rig has begun to publish, as its log says.
bool are_publishing(const DemoStage& stage) {
    constexpr std::size_t max_log_bytes = 1 << 20;
    return std::all_of(stage.rigs().begin(), stage.rigs().end(), [&](const std::string& name) {
        const std::filesystem::path log = stage.folder() / (name + ".log");
        return read_text_file(log, max_log_bytes).find("publishing on ") != std::string::npos;
    });
}

LiveOptions live_options(const DemoOptions& options, const std::filesystem::path& folder,
                         const DemoStage& stage, const std::string& rate,
                         const std::filesystem::path& move) {
    LiveOptions live;
    live.stage = stage.stage_file();
    live.wait_s = 300;  // with a software renderer the rigs render their loop first
    live.show.rate = rate;
    live.show.path = move;
    live.show.flight = folder / ("flight-" + move.filename().string());
    live.takes = folder;
    live.show.json = options.json;
    live.show.trace = options.trace;
    if (!options.headless) {
        live.show.outputs = {"file:" + (folder / "programme.mkv").string() + "?start=off"};
        live.show.overwrite = true;
        return live;
    }
    live.show.headless = true;
    live.past_mb = 64;  // there is no replay without a window
    live.show.seconds = options.seconds;
    live.show.flight.clear();
    live.show.film = folder / "flight.mkv";
    live.show.overwrite = true;
    live.show.contact_sheet = folder / "contact_sheet.png";
    live.show.snapshot = folder / "last_view.png";
    return live;
}

/// Warns about the files of an earlier demo that this one replaces.
void warn_of_replaced_files(const LiveOptions& live) {
    std::vector<std::string> old;
    for (const std::string& file : {live.show.film, live.show.contact_sheet, live.show.snapshot})
        if (!file.empty() && std::filesystem::exists(file))
            old.push_back(std::filesystem::path(file).filename().string());
    if (!old.empty())
        log_warning("in {} this flight replaces {}; use --folder to keep them",
                    std::filesystem::path(live.show.film).parent_path().string(),
                    fmt::join(old, ", "));
}

bool has_display() {
    for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"})
        if (const char* value = std::getenv(name); value && *value) return true;
    return false;
}

void demo(DemoOptions options) {
    options.headless = options.headless || !has_display();
    if (!options.rig.empty()) (void)load_calibration(options.rig.front());
    const std::filesystem::path folder = std::filesystem::absolute(options.folder);
    DemoStage stage(folder / "demo", options.kept.empty()
                                         ? std::filesystem::path()
                                         : std::filesystem::absolute(options.kept));
    const AskProgram ask = [&](const std::string& name, const std::vector<std::string>& arguments) {
        return ask_program(stage.folder(), name, arguments);
    };
    const auto match_ms = [&](const DemoSize& tried) {
        return match_ms_of(tried, stage.folder() / "trial", ask);
    };
    DemoSize size;
    if (ask("vantage-rig", {"probe", "--json", "--quick"})
            .value("/gpu/is_software"_json_pointer, true)) {
        size = software_demo_size();
        if (options.films_the_stage() && !options.sweep)
            size.rate_hz = software_rate_hz(4, match_ms(size));
    } else if (options.films_the_stage()) {
        size = gpu_demo_size(4, match_ms);
    }
    std::string move_name = "demo.toml", move = demo_move(move_name);
    if (options.sweep) {
        // Thirteen rigs share the time of four.
        size.rate_hz = size.is_software ? 1 : 5;
        size.latency_budget_ms = 2000;
        add_virtual_rigs(13, size, stage);
        move_name = "sweep.toml";
        move = demo_move(move_name);
    } else if (options.films_the_stage()) {
        add_virtual_rigs(4, size, stage);
    } else {
        const std::vector<std::string>& sides = options.rig.empty() ? options.files : options.rig;
        FilmedPair pair;
        pair.left = std::filesystem::absolute(sides.end()[-2]);
        pair.right = sides.back() == "-" ? std::filesystem::path("-")
                                         : std::filesystem::absolute(sides.back());
        if (!options.rig.empty()) pair.calibration = std::filesystem::absolute(options.rig.front());
        pair.disparities = options.disparities;
        pair.rate_hz = options.rate_hz;
        move = add_filmed_rig(pair, ask, stage, size);
        move_name = options.rig.empty() ? "pair.toml" : "rig.toml";
    }
    stage.write(size);
    const std::filesystem::path move_file = stage.folder() / ("move-" + move_name);
    write_text_atomically(move_file, move);

    const auto rigs = start_rigs(stage, size.is_software);
    log_info("started {} at {:.4g} pulses per second; logs are in {}",
             rigs.size() == 1 ? "a rig"
             : options.films_the_stage()
                 ? fmt::format("{} rigs of {}x{}", rigs.size(), size.rig[0], size.rig[1])
                 : fmt::format("{} rigs", rigs.size()),
             size.rate_hz, stage.folder().string());
    if (options.films_the_stage() && size.is_software)
        log_info("the rigs render the stage's loop of 24 s before they start, which takes seconds");
    if (options.rigs_only) {
        StopSignal stop;
        fmt::print("ready: {}\n", stage.stage_file().string());
        std::fflush(stdout);
        // Later a rig may end and be started anew by whoever plays with them.
        bool is_begun = false;
        while (!stop.wait_for(std::chrono::milliseconds(200))) {
            if (is_begun) continue;
            require_running(rigs, stage);
            is_begun = are_publishing(stage);
        }
        return;
    }
    // With material of a real rig and a window, the camera starts at the rig.
    const bool flies = options.rig.empty() || options.headless;
    LiveOptions live = live_options(options, folder, stage, size.rate, move_file);
    if (!flies) live.show.path.clear();
    live.while_waiting = [&] { require_running(rigs, stage); };
    warn_of_replaced_files(live);
    run_live_session(live);
    if (options.headless && !options.json)
        fmt::print("\nFlight:        {}\nContact sheet: {}\n", live.show.film,
                   live.show.contact_sheet);
}

}  // namespace

CommandEntry demo_command_entry() {
    return {[](CLI::App& program) {
        auto options = std::make_shared<DemoOptions>();
        CLI::App* command = program.add_subcommand(
            "demo", "Try Vantage on this computer: start virtual rigs and fly around their stage");
        CLI::Option* files = command
                                 ->add_option("--files", options->files,
                                              "Play one rectified pair instead of the virtual "
                                              "stage")
                                 ->expected(2)
                                 ->type_name("LEFT RIGHT");
        CLI::Option* rig =
            command
                ->add_option("--rig", options->rig,
                             "Play recordings of a real rig with its calibration: for each side a "
                             "picture, a folder, 'pattern*.png' or a video; RIGHT '-': both sides "
                             "in one picture")
                ->expected(3)
                ->type_name("CALIB.yaml LEFT RIGHT")
                ->excludes(files);
        command
            ->add_option("--disparities", options->disparities,
                         "Set the number of disparities (default: a quarter of the width)")
            ->check(CLI::Range(1, 256))
            ->needs(rig);
        command
            ->add_option("--rate", options->rate_hz,
                         "Set the frame rate (default: the video's, or less on a slow computer)")
            ->check(CLI::Range(0.01, 1000.0))
            ->needs(rig);
        command
            ->add_option("--folder", options->folder,
                         "Put films, takes, logs and keys into this folder; films and pictures of "
                         "an earlier demo are replaced")
            ->capture_default_str();
        command
            ->add_flag(
                "--sweep", options->sweep,
                "Start 13 rigs 20 degrees apart and fly along all of them; Space freezes the "
                "instant")
            ->excludes(rig)
            ->excludes(files);
        command->add_flag("--headless", options->headless,
                          "Write the flight as a film and a contact sheet, without a window; the "
                          "default without a display");
        command
            ->add_option("--seconds", options->seconds,
                         "With --headless: set the length of the flight")
            ->check(CLI::PositiveNumber)
            ->capture_default_str();
        command->add_flag("--json", options->json, "Print the summary as JSON");
        command->add_option("--trace", options->trace, trace_help)->type_name("FILE");
        command->add_flag("--rigs-only", options->rigs_only,
                          "Start only the rigs, print the path of their stage file, and wait, so "
                          "that other hosts "
                          "can use them");
        command->add_option("--keep", options->kept, "Let the rigs record takes to this folder");
        command->footer(
            "Without a GPU the processor renders everything; the pictures are then smaller and the "
            "rates lower.");
        command->callback([options] { demo(*options); });
    }};
}

}  // namespace vantage
