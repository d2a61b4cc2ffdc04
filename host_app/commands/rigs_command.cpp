#include <algorithm>
#include <iostream>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/base/command.h"
#include "common/base/error.h"
#include "common/base/stop_signal.h"
#include "common/base/time_zone.h"
#include "common/config/stage_config.h"
#include "common/receive/stage_receiver.h"
#include "common/wire/status_report.h"
#include "host_app/live/live_report.h"

namespace vantage {
namespace {

struct Options {
    std::string stage;
    double wait_s = 3;
    bool json = false;
};

/// Looks until every rig has answered, or the time is up. Frames are not asked for.
ReceiverStatus look(const StageConfig& stage, double wait_s) {
    StageReceiver receiver(stage, StageReceiver::Purpose::look_on);
    StopSignal stop;
    constexpr std::chrono::milliseconds look_every(50);
    const MonotonicTime end =
        MonotonicClock::now() +
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(wait_s));
    while (MonotonicClock::now() < end && !stop.wait_for(look_every)) {
        const ReceiverStatus status = receiver.status();
        bool all = true;
        for (const RigStatus& rig : status.rigs)
            all = all && (rig.connected || !rig.refused.empty());
        if (all) break;
    }
    return receiver.status();
}

/// Whether it gives pictures, as far as its own numbers say.
bool delivers(const RigStatus& rig) {
    return trouble_of(rig).empty() && rig.health.published_hz > 0;
}

/// Of the stage as a whole. Onlookers get no pictures, so there is nothing to be stale.
SignalState signal_of(const ReceiverStatus& status) {
    return std::any_of(status.rigs.begin(), status.rigs.end(), delivers) ? SignalState::live
                                                                         : SignalState::no_signal;
}

nlohmann::ordered_json to_json(const RigStatus& rig) {
    nlohmann::ordered_json json{{"name", rig.rig}, {"state", state_of(rig)}};
    if (const std::string trouble = trouble_of(rig); !trouble.empty()) json["trouble"] = trouble;
    json["delivers"] = delivers(rig);
    json["clock"] = clock_text(rig);
    json["same_clock"] = rig.same_clock;
    json["sync"] = to_json(rig.sync);
    json["health"] = to_json(rig.health);
    json["frames"] = to_json(rig.since_start);
    return json;
}

void print(const ReceiverStatus& status) {
    for (const RigStatus& rig : status.rigs) {
        std::cout << fmt::format("{}: {}\n", rig.rig, full_state_of(rig));
        if (!rig.connected) continue;
        const RigCounters& counters = rig.since_start;
        std::cout << fmt::format(
            "    {}\n    {}\n    since it started: captured {}, missed {}, late {}, published {}\n",
            clock_text(rig), health_text(rig.health), counters.captured, counters.missed,
            counters.late, counters.published);
        if (const std::string pulses = pulse_text(rig.sync); !pulses.empty())
            std::cout << "    " << pulses << '\n';
    }
    std::cout << "signal: " << title_of(signal_of(status)) << '\n';
}

void run(const Options& options) {
    const StageConfig stage = load_stage_config(options.stage);
    if (!stage.timecode_zone.empty()) use_time_zone(stage.timecode_zone);
    const ReceiverStatus status = look(stage, options.wait_s);
    if (options.json) {
        nlohmann::ordered_json all = nlohmann::ordered_json::array();
        for (const RigStatus& rig : status.rigs) all.push_back(to_json(rig));
        std::cout
            << nlohmann::ordered_json{{"signal", key_of(signal_of(status))}, {"rigs", all}}.dump()
            << '\n';
    } else {
        print(status);
    }
    std::string troubles;
    std::size_t troubled = 0;
    for (const RigStatus& rig : status.rigs)
        if (const std::string trouble = trouble_of(rig); !trouble.empty()) {
            troubles += fmt::format("; {}: {}", rig.rig, trouble);
            ++troubled;
        }
    if (troubled > 0) fail("{} of {} rigs cannot serve{}", troubled, status.rigs.size(), troubles);
}

}  // namespace

CommandEntry rigs_command_entry() {
    return {[](CLI::App& program) {
        CLI::App* rigs = program.add_subcommand("rigs", "The rigs of a stage");
        rigs->require_subcommand(1);
        auto options = std::make_shared<Options>();
        CLI::App* status = rigs->add_subcommand("status",
                                                "Every rig: clock, pulses, rates, temperature, "
                                                "calibration, what became of its frames; ends "
                                                "with 1 if a rig cannot serve, and says why");
        status->add_option("--stage", options->stage, "stage.toml (see hw_config/stage.toml)")
            ->required();
        status->add_option("--wait", options->wait_s, "Seconds to wait for rigs (default 3)")
            ->check(CLI::Range(0.1, 3600.0));
        status->add_flag("--json", options->json, "Print it as JSON");
        status->callback([options] { run(*options); });
    }};
}

}  // namespace vantage
