// How many rigs of full size one host receives, decodes, joins and records, and what that costs it;
// what a relay costs. Writes the tables of docs/results/scale.md.
#include <algorithm>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <thread>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "common/base/child_process.h"
#include "common/base/error.h"
#include "common/gl/context/egl_context.h"
#include "common/receive/stage_receiver.h"
#include "common/take/take_recorder.h"
#include "common/wire/curve_keys.h"
#include "tests/bench/scale/full_size_frames.h"
#include "tests/bench/scale/scale_rigs.h"
#include "tests/bench/support/markdown_tables.h"
#include "tests/bench/support/run_bench.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

struct Case {
    std::string words;
    int looked_at = 0;  ///< rigs whose pictures are decoded; -1: all
    bool is_recorded = false;
};

/// Processor time by the names of this process's threads, in seconds.
std::map<std::string, double> thread_times_s() {
    std::map<std::string, double> times;
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
        std::string name;
        double ns = 0;
        std::getline(std::ifstream(task.path() / "comm"), name);
        if (std::ifstream(task.path() / "schedstat") >> ns)
            times[name.starts_with("ZMQbg/IO") ? "network" : name] += ns / 1e9;
    }
    return times;
}

struct Result {
    nlohmann::json rigs;
    ReceiverStatus host;
    TakeState take;
    double seconds = 0, cpu_s = 0;
    std::map<std::string, double> steps_s;
    std::uint64_t sum(std::uint64_t RigStatus::*count) const {
        std::uint64_t all = 0;
        for (const RigStatus& rig : host.rigs) all += rig.*count;
        return all;
    }
};

nlohmann::json json_of(const std::filesystem::path& file) {
    return nlohmann::json::parse(std::ifstream(file));
}

/// That the other process leaves. Throws Error if it ends without.
void wait_for(const std::filesystem::path& file, ChildProcess& from) {
    while (!std::filesystem::exists(file)) {
        if (from.ended()) fail("no {} came", file.filename().string());
        std::this_thread::sleep_for(10ms);
    }
}

ScaleFolder keyed_folder(const std::filesystem::path& path) {
    const ScaleFolder folder{path};
    std::ofstream rig_hosts(folder.file("rig.hosts")), relay_hosts(folder.file("relay.hosts"));
    for (const char* name : {"rig", "host", "relay"}) {
        const CurveKeys keys = generate_curve_keys();
        write_key_file(folder.file((std::string(name) + ".key").c_str()), keys);
        rig_hosts << keys.public_key << " " << name << "\n";
        relay_hosts << keys.public_key << " " << name << "\n";
    }
    return folder;
}

ChildProcess::Settings self(std::vector<std::string> arguments) {
    return {
        std::filesystem::read_symlink("/proc/self/exe"), std::move(arguments), {}, "/dev/stderr"};
}

Result measure(const ScaleRigs& wanted, const Case& how) {
    const TemporaryFolder temporary;
    const ScaleFolder folder = keyed_folder(temporary.path());
    ChildProcess rigs(self({"rigs", folder.path, "--take", wanted.take, "--rigs",
                            std::to_string(wanted.rigs), "--rate", std::to_string(wanted.rate_hz),
                            "--seconds", std::to_string(wanted.seconds), "--hosts", "1"}));
    wait_for(folder.file("stage.toml"), rigs);
    const StageConfig stage = load_stage_config(folder.file("stage.toml"));
    TakeRecorder::Settings settings;
    for (const StageConfig::Rig& rig : stage.rigs) settings.rigs.push_back(rig.name);
    settings.pulse_rate_hz = wanted.rate_hz;
    settings.may_be_empty = true;
    settings.program = "scale_bench";
    settings.disk_mb_s = [](const std::filesystem::path&) { return 1e9; };
    TakeRecorder recorder(settings);
    if (how.is_recorded) recorder.begin(folder.file("take.mkv"));
    Result result;
    {
        StageReceiver host(stage, StageReceiver::Purpose::film,
                           [&](const ArrivedFrame& frame) { recorder.offer(frame); });
        for (std::size_t i = 0; i < stage.rigs.size(); ++i)
            host.set_decoded(stage.rigs[i].name,
                             how.looked_at < 0 || i < static_cast<std::size_t>(how.looked_at));
        const auto came = [&] {
            const ReceiverStatus status = host.status();
            return std::any_of(status.rigs.begin(), status.rigs.end(),
                               [](const RigStatus& rig) { return rig.received > 0; });
        };
        while (!came()) std::this_thread::sleep_for(5ms);
        const double before_s = cpu_s();
        const std::map<std::string, double> steps_before = thread_times_s();
        const auto begin = std::chrono::steady_clock::now();
        std::optional<FrameSet> newest;
        while (!std::filesystem::exists(folder.file("rigs.json")))
            if (std::optional<FrameSet> set = host.next(20ms)) newest = std::move(set);
        result.seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        result.cpu_s = cpu_s() - before_s;
        result.steps_s = thread_times_s();
        for (const auto& [name, time_s] : steps_before) result.steps_s[name] -= time_s;
        result.host = host.status();
    }
    recorder.finish();
    result.take = recorder.state();
    result.rigs = json_of(folder.file("rigs.json"));
    std::ofstream(folder.file("done")) << "\n";
    return result;
}

void print(const Result& it, const Case& how, int rigs, std::ostream& flow, std::ostream& cost) {
    const double filmed = it.rigs["frames"], seconds = it.rigs["seconds"];
    const double frame_mb = it.rigs["frame_bytes"].get<double>() / 1e6;
    const auto came = static_cast<double>(it.sum(&RigStatus::received));
    const auto per_cent = [](double part, double whole) {
        return whole > 0 ? 100 * part / whole : 0.0;
    };
    std::uint64_t left_out = 0;
    for (const TakeState::Rig& rig : it.take.rigs) left_out += rig.dropped + rig.refused;
    flow << fmt::format(
        "| {} | {} | {:.0f} | {:.0f} | {:.1f} % | {:.1f} % | {} | {} | {} | {} |\n", rigs,
        how.words, came / seconds, came * frame_mb / seconds, per_cent(came, filmed),
        per_cent(static_cast<double>(it.host.complete_frame_sets), filmed / rigs),
        it.rigs["send_dropped"].get<std::uint64_t>(), it.sum(&RigStatus::queue_dropped),
        it.sum(&RigStatus::late), how.is_recorded ? std::to_string(left_out) : "–");
    // Threads that came and went are the take's coders.
    const auto step = [&](const char* name) {
        const auto found = it.steps_s.find(name);
        return found == it.steps_s.end() ? 0.0 : found->second;
    };
    const double network = step("network"), receive = step("receive"), decode = step("decode");
    const double rest = it.cpu_s - network - receive - decode;
    const auto ms = [&](double s) { return came > 0 ? 1e3 * s / came : 0.0; };
    cost << fmt::format(
        "| {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |\n", rigs,
        how.words, ms(network), ms(receive), ms(decode), ms(rest), ms(it.cpu_s),
        it.cpu_s / it.seconds, it.rigs["cpu_s"].get<double>() / seconds);
}

/// What a relay costs, by the hosts behind it.
std::string measure_relay(ScaleRigs wanted) {
    std::string rows;
    for (const int hosts : {1, 2, 4}) {
        const TemporaryFolder temporary;
        const ScaleFolder folder = keyed_folder(temporary.path());
        ChildProcess rigs(
            self({"rigs", folder.path, "--take", wanted.take, "--rigs", std::to_string(wanted.rigs),
                  "--rate", std::to_string(wanted.rate_hz), "--seconds",
                  std::to_string(wanted.seconds), "--hosts", "1"}));
        wait_for(folder.file("stage.toml"), rigs);
        std::ifstream stage(folder.file("stage.toml"));
        std::string text{std::istreambuf_iterator<char>(stage), {}};
        text.replace(text.find("host.key"), 8, "relay.key");
        std::ofstream(folder.file("relay.toml")) << text << std::flush;
        ChildProcess relay(self({"relay", folder.path}));
        wait_for(folder.file("behind.toml"), relay);
        std::vector<std::unique_ptr<StageReceiver>> behind;
        for (int i = 0; i < hosts; ++i) {
            behind.push_back(
                std::make_unique<StageReceiver>(load_stage_config(folder.file("behind.toml"))));
            for (int rig = 0; rig < wanted.rigs; ++rig)
                behind.back()->set_decoded(fmt::format("rig{:02}", rig), false);
        }
        wait_for(folder.file("relay.json"), relay);
        const nlohmann::json at_rigs = json_of(folder.file("rigs.json")),
                             at_relay = json_of(folder.file("relay.json"));
        std::uint64_t received = 0;
        for (const auto& host : behind)
            for (const RigStatus& rig : host->status().rigs) received += rig.received;
        const double frames = at_relay["frames"];
        rows += fmt::format("| {} | {} | {} | {} | {:.1f} | {:.2f} |\n", hosts,
                            at_rigs["sent"].get<std::uint64_t>(), frames, received,
                            1e-6 * at_relay["bytes"].get<double>() / wanted.seconds,
                            1e3 * at_relay["cpu_s"].get<double>() / frames);
        std::ofstream(folder.file("done")) << "\n";
    }
    return rows;
}

void film(const std::filesystem::path& take) {
    const EglContext context;
    const ShaderLibrary shaders;
    TakeRecorder::Settings settings;
    settings.program = "scale_bench";
    settings.disk_mb_s = [](const std::filesystem::path&) { return 1e9; };
    std::vector<ArrivedFrame> frames;
    for (const double place_deg : {-30.0, -10.0, 10.0, 30.0}) {
        for (PackedFrame& frame :
             film_full_size(shaders, {}, place_deg, settings.rigs.size() + 1)) {
            ArrivedFrame& arrived = frames.emplace_back();
            arrived.rig = settings.rigs.size();
            arrived.packed = std::make_shared<const PackedFrame>(std::move(frame));
        }
        settings.rigs.push_back(decode_frame_head(frames.back().packed->header).frame.rig);
    }
    TakeRecorder recorder(settings);
    recorder.begin(take);
    for (ArrivedFrame& frame : frames) {
        frame.arrival = MonotonicClock::now();
        frame.arrival_tai = TaiClock::now();
        recorder.offer(frame);
    }
    recorder.finish();
    if (!recorder.state().failure.empty()) fail("{}", recorder.state().failure);
}

void run(ScaleRigs wanted, const std::vector<int>& sizes, int relayed,
         const std::string& document) {
    const TemporaryFolder folder;
    if (wanted.take.empty()) {
        wanted.take = folder.path() / "filmed.mkv";
        film(wanted.take);
    }
    const std::vector<Case> cases{{"receive", 0, false},
                                  {"receive, record", 0, true},
                                  {"receive, decode five, record", 5, true},
                                  {"receive, decode all", -1, false},
                                  {"receive, decode all, record", -1, true}};
    std::ostringstream flow, cost, text;
    double frame_kb = 0;
    for (const int rigs : sizes)
        for (const Case& how : cases) {
            wanted.rigs = rigs;
            const Result result = measure(wanted, how);
            print(result, how, rigs, flow, cost);
            frame_kb = result.rigs["frame_bytes"].get<double>() / 1e3;
            std::cerr << rigs << " rigs, " << how.words << "\n";
        }
    double load = 0;
    std::ifstream("/proc/loadavg") >> load;
    text << fmt::format(
        "Frames of {:.0f} kB, {:g} per second and rig, {:g} s each; {} processors for rigs and "
        "host "
        "together, load {:.0f} at the end.\n\n"
        "| rigs | the host's work | frames/s | MB/s | arrived | frame sets complete | "
        "dropped at rigs | dropped at host | late | not in the take |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n{}\n"
        "Processor time of the host by step, in ms for each frame that arrived, and the processors "
        "that host and rigs used.\n\n"
        "| rigs | the host's work | network, decryption | copies, frame sets | decode | recording "
        "| all | host: processors | rigs: processors |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n{}\n",
        frame_kb, wanted.rate_hz, wanted.seconds, sysconf(_SC_NPROCESSORS_ONLN), load, flow.str(),
        cost.str());
    wanted.rigs = relayed;
    text << fmt::format(
        "A relay of {} rigs, by the number of hosts behind it.\n\n"
        "| hosts | frames sent by the rigs | received by the relay | received by the hosts | MB/s "
        "from the rigs | relay: ms per frame |\n| --- | --- | --- | --- | --- | --- |\n{}\n",
        relayed, measure_relay(wanted));
    std::cout << text.str();
    if (!document.empty()) put_between_markers(document, text.str());
}

}  // namespace
}  // namespace vantage

int main(int argc, char** argv) {
    using namespace vantage;
    CLI::App app("How many rigs one host takes, and what that costs");
    ScaleRigs wanted;
    std::vector<int> sizes{8, 16, 32};
    int relayed = 4;
    std::string document;
    ScaleFolder folder;
    const auto add_rigs = [&](CLI::App& to) {
        to.add_option("--take", wanted.take, "Of full-size rigs, to be replayed (default: filmed)");
        to.add_option("--rate", wanted.rate_hz, "Pulses a second")->capture_default_str();
        to.add_option("--seconds", wanted.seconds, "Of each measurement")->capture_default_str();
    };
    add_rigs(app);
    app.add_option("--sizes", sizes, "Of the stage, in rigs")->capture_default_str();
    app.add_option("--relayed", relayed, "Rigs behind the relay")->capture_default_str();
    app.add_option("--write", document, "Document whose tables are written anew");
    std::string film_to;
    app.add_option("--film", film_to, "Only film the take that is replayed, and keep it there");
    CLI::App* rigs = app.add_subcommand("rigs", "The rigs' process");
    rigs->add_option("FOLDER", folder.path)->required();
    add_rigs(*rigs);
    rigs->add_option("--rigs", wanted.rigs);
    rigs->add_option("--hosts", wanted.hosts);
    CLI::App* relay = app.add_subcommand("relay", "The relay's process");
    relay->add_option("FOLDER", folder.path)->required();
    CLI11_PARSE(app, argc, argv);
    return run_bench("scale_bench", [&] {
        if (rigs->parsed()) return serve_scale_rigs(folder, wanted);
        if (relay->parsed()) return serve_scale_relay(folder);
        if (!film_to.empty()) return film(film_to);
        run(wanted, sizes, relayed, document);
    });
}
