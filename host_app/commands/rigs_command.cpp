#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "common/base/cli/command.h"
#include "common/base/cli/stop_signal.h"
#include "common/base/error.h"
#include "common/base/files/folder.h"
#include "common/base/log.h"
#include "common/base/time/time.h"
#include "common/base/time/time_zone.h"
#include "common/config/stage_config.h"
#include "common/take/take_pulses.h"
#include "common/wire/status_report.h"
#include "host_app/commands/rigs/rigs_commands.h"
#include "host_app/session/options/common_options.h"
#include "host_app/session/report/live_report.h"
#include "host_app/session/sync_proof.h"
#include "host_app/takes/clock_time.h"
#include "host_app/takes/rig_fetch.h"

namespace vantage {
namespace {

struct FetchOptions {
    std::string stage, from, to, take;
    std::vector<std::string> rigs;
    std::filesystem::path folder = "fetched";
    double mb_s = 20, wait_s = 10;
    bool json = false;
};

struct RigsOptions {
    std::string stage;
    double wait_s = 10;
    bool json = false;
};

/// Returns the signal of the stage. This command requests no frames, so it is never stale.
SignalState signal_of(const ReceiverStatus& status) {
    const bool any_rig =
        std::any_of(status.rigs.begin(), status.rigs.end(),
                    [&](const RigStatus& rig) { return delivers(rig, status.rigs); });
    return any_rig ? SignalState::live : SignalState::no_signal;
}

void print(const ReceiverStatus& status, const std::string& synchronisation) {
    for (const RigStatus& rig : status.rigs) {
        std::cout << fmt::format("{}: {}\n", rig.rig, full_state_of(rig));
        if (!rig.connected) continue;
        if (const std::string silence = silence_of(rig); !silence.empty())
            std::cout << "    " << silence << '\n';
        const RigCounters& counters = rig.since_start;
        std::cout << fmt::format(
            "    {}\n    {}\n    since it started: captured {}, missed {}, late {}, published {}\n",
            clock_text(rig), health_text(rig.health), counters.captured, counters.missed,
            counters.late, counters.published);
        if (const std::string pulses = pulse_text(rig.sync); !pulses.empty())
            std::cout << "    " << pulses << '\n';
    }
    std::cout << "synchronisation: " << synchronisation << '\n';
    std::cout << "signal: " << title_of(signal_of(status)) << '\n';
}

void run(const RigsOptions& options) {
    const StageConfig stage = load_stage_config(options.stage);
    if (!stage.timecode_zone.empty()) use_time_zone(stage.timecode_zone);
    StopSignal stop;
    const ReceiverStatus status =
        gather_status(stage, options.wait_s, StatusCondition::all_send, stop);
    const SyncProof proof = sync_proof_of(options.stage);
    const auto now = std::chrono::system_clock::now();
    if (options.json) {
        nlohmann::ordered_json all = nlohmann::ordered_json::array();
        for (const RigStatus& rig : status.rigs) all.push_back(to_json(rig, status.rigs));
        std::cout << nlohmann::ordered_json{{"signal", key_of(signal_of(status))},
                                            {"sync_proof", to_json(proof, now)},
                                            {"rigs", all}}
                         .dump()
                  << '\n';
    } else {
        print(status, sync_words(proof, now));
    }
    std::vector<std::string> troubles;
    for (const RigStatus& rig : status.rigs) {
        // A rig that waits for a host to start is ready.
        const std::string trouble =
            waits_for_a_host(rig) ? trouble_of(rig) : trouble_of(rig) + silence_of(rig);
        if (trouble.empty()) continue;
        // The printed table already has the reasons.
        troubles.push_back(options.json ? fmt::format("{}: {}", rig.rig, trouble) : rig.rig);
    }
    if (!troubles.empty())
        fail("{} of {} rigs cannot send frames{}{}", troubles.size(), status.rigs.size(),
             options.json ? "; " : ": ", fmt::join(troubles, options.json ? "; " : ", "));
}

/// Sets the range of pulses to fetch: --from and --to, or the gaps of a take.
void plan(const FetchOptions& options, const StageConfig& stage, KeptFetch& fetch) {
    if (options.take.empty()) {
        if (options.from.empty() || options.to.empty())
            fail("nothing to fetch: give --from and --to, or a take with --gaps-of");
        const ClockSpan span = clock_span(options.from, options.to, std::time(nullptr));
        const PulseGrid pulses(stage.rate_hz);
        // Both are parsed here, so that errors are reported before any rig is contacted.
        constexpr int no_offset_s = 0;
        (void)pulse_of(span.to, pulses, no_offset_s);
        (void)pulse_of(span.from, pulses, no_offset_s);
        fetch.range = [span, pulses](int tai_offset_s) {
            return PulseRange{pulse_of(span.from, pulses, tai_offset_s),
                              pulse_of(span.to, pulses, tai_offset_s)};
        };
        return;
    }
    fetch.take = std::make_shared<const TakeReader>(options.take);
    if (fetch.take->facts().pulse_rate_hz != stage.rate_hz)
        fail("{} has {:g} pulses per second, but the stage has {:g}", options.take,
             fetch.take->facts().pulse_rate_hz, stage.rate_hz);
    const PulseSpan span = pulse_span_of(*fetch.take);
    const PulseRange range{
        options.from.empty() ? span.first
                             : pulse_of(*fetch.take, options.from, span.first, span.last),
        options.to.empty() ? span.last + 1
                           : pulse_of(*fetch.take, options.to, span.first, span.last)};
    if (range.pulses() == 0) fail("--from {} is not before --to {}", options.from, options.to);
    fetch.range = [range](int) { return range; };
}

nlohmann::ordered_json to_json(const FetchStats& stats) {
    nlohmann::ordered_json json{{"name", stats.rig},          {"wanted", stats.wanted},
                                {"frames", stats.frames},     {"bytes", stats.bytes},
                                {"not_kept", stats.not_kept}, {"were_there", stats.there}};
    if (!stats.trouble.empty()) json["trouble"] = stats.trouble;
    json["files"] = nlohmann::ordered_json::array();
    for (const std::filesystem::path& file : stats.files) json["files"].push_back(file.string());
    return json;
}

void log_fetch_progress(const std::vector<FetchStats>& all) {
    for (const FetchStats& stats : all)
        if (stats.wanted > 0 && !stats.is_done)
            log_info("{}: {} of {} pulses ({} %), {:.1f} MB", stats.rig, stats.seen, stats.wanted,
                     100 * stats.seen / stats.wanted, static_cast<double>(stats.bytes) / 1e6);
}

void fetch_kept(const FetchOptions& options) {
    const StageConfig stage = load_stage_config(options.stage);
    if (!stage.timecode_zone.empty()) use_time_zone(stage.timecode_zone);
    KeptFetch fetch;
    plan(options, stage, fetch);
    fetch.rigs = options.rigs;
    fetch.folder = options.folder;
    constexpr double bytes_a_mb = 1e6;
    fetch.bytes_s = bytes_a_mb * options.mb_s;
    fetch.patience = from_s(options.wait_s);
    make_folder(options.folder);
    StopSignal stop;
    const std::vector<FetchStats> all = fetch.run(
        stage, [&] { return stop.requested(); }, log_fetch_progress);
    if (options.json) {
        nlohmann::ordered_json rigs = nlohmann::ordered_json::array();
        for (const FetchStats& stats : all) rigs.push_back(to_json(stats));
        std::cout
            << nlohmann::ordered_json{{"folder", options.folder.string()}, {"rigs", rigs}}.dump()
            << '\n';
    } else {
        for (const FetchStats& stats : all) {
            std::cout << fmt::format("{}: {} frames, {:.1f} MB", stats.rig, stats.frames,
                                     static_cast<double>(stats.bytes) / 1e6);
            if (stats.not_kept > 0)
                std::cout << fmt::format("; the rig has not recorded {} pulses", stats.not_kept);
            std::cout << '\n';
            for (const std::filesystem::path& file : stats.files)
                std::cout << "    " << file.string() << '\n';
        }
    }
    std::string troubles;
    for (const FetchStats& stats : all)
        if (!stats.trouble.empty()) troubles += (troubles.empty() ? "" : "; ") + stats.trouble;
    if (!troubles.empty()) fail("{}", troubles);
    if (std::any_of(all.begin(), all.end(), [](const auto& stats) { return !stats.is_done; }))
        fail("ended before everything was fetched; run the same command to continue");
}

}  // namespace

CommandEntry rigs_command_entry() {
    return {[](CLI::App& program) {
        CLI::App* rigs = program.add_subcommand("rigs", "Check and maintain the rigs of a stage");
        rigs->require_subcommand(1);
        auto options = std::make_shared<RigsOptions>();
        CLI::App* status = rigs->add_subcommand("status",
                                                "Print the state of every rig: clock, pulses, "
                                                "rates, temperature, calibration and frames; exit "
                                                "with 1 if a rig cannot send frames");
        status->add_option("--stage", options->stage, stage_file_help)->required();
        status
            ->add_option("--wait", options->wait_s,
                         "Wait at most this many seconds for rigs that do not answer or send")
            ->capture_default_str()
            ->check(CLI::Range(0.1, 3600.0));
        status->add_flag("--json", options->json, "Print the result as JSON");
        status->callback([options] { run(*options); });

        auto fetched = std::make_shared<FetchOptions>();
        CLI::App* fetch = rigs->add_subcommand(
            "fetch",
            "Copy the rigs' own recordings ([keep]) to this host, also during a live show; an "
            "interrupted copy is resumed, and vantage take join makes one take of the files");
        fetch->add_option("--stage", fetched->stage, stage_file_help)->required();
        fetch->add_option("--from", fetched->from,
                          "Start at this time of day at the stage: 20:15:00, 20:15:00:12 (time "
                          "code) or 2026-11-22T20:15:00; with --gaps-of as in vantage take cut");
        fetch->add_option("--to", fetched->to, "End at this time, which is not included, likewise");
        fetch->add_option("--gaps-of", fetched->take,
                          "Fetch only the frames that this take lacks (default range: the whole "
                          "take)");
        fetch->add_option("--rig", fetched->rigs,
                          "Fetch from this rig only; repeat the option for more (default: all)");
        fetch->add_option("-o,--output", fetched->folder, "Write the files to this folder")
            ->capture_default_str();
        fetch
            ->add_option("--mb-s", fetched->mb_s,
                         "Limit the transfer from all rigs together to this many MB/s, so that a "
                         "live show is not disturbed")
            ->check(CLI::Range(0.01, 10'000.0))
            ->capture_default_str();
        fetch
            ->add_option("--wait", fetched->wait_s,
                         "Wait at most this many seconds for a silent rig")
            ->check(CLI::Range(0.1, 86'400.0))
            ->capture_default_str();
        fetch->add_flag("--json", fetched->json, "Print the result as JSON");
        fetch->callback([fetched] { fetch_kept(*fetched); });
        add_rigs_plan(*rigs);
        add_rigs_update(*rigs);
        add_rigs_bugreport(*rigs);
    }};
}

ReceiverStatus gather_status(const StageConfig& stage, double wait_s, StatusCondition condition,
                             StopSignal& stop) {
    StageReceiver receiver(stage, StageReceiver::Purpose::report);
    const auto has_answered = [&](const RigStatus& rig) {
        if (condition == StatusCondition::all_send && rig.connected)
            return rig.health.published_hz > 0 || waits_for_a_host(rig) || !trouble_of(rig).empty();
        return rig.connected ||
               (condition != StatusCondition::all_connected && !rig.refused.empty());
    };
    const MonotonicTime end = MonotonicClock::now() + from_s(wait_s);
    while (MonotonicClock::now() < end && !stop.wait_for(StopSignal::look_period)) {
        const ReceiverStatus status = receiver.status();
        if (std::all_of(status.rigs.begin(), status.rigs.end(), has_answered)) break;
    }
    return receiver.status();
}

nlohmann::ordered_json to_json(const RigStatus& rig, const std::vector<RigStatus>& rigs) {
    nlohmann::ordered_json json{{"name", rig.rig},
                                {"endpoint", rig.endpoint},
                                {"connected", rig.connected},
                                {"state", state_of(rig)}};
    if (const std::string trouble = trouble_of(rig); !trouble.empty()) json["trouble"] = trouble;
    if (const std::string silence = silence_of(rig); !silence.empty()) json["silence"] = silence;
    json["delivers"] = delivers(rig, rigs);
    json["clock"] = clock_text(rig);
    json["same_clock"] = rig.same_clock;
    json["sync"] = to_json(rig.sync);
    json["health"] = to_json(rig.health);
    json["frames"] = to_json(rig.since_start);
    return json;
}

}  // namespace vantage
