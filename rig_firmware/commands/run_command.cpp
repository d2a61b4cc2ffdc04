#include <iostream>
#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "common/base/command.h"
#include "common/base/log.h"
#include "common/base/stop_signal.h"
#include "common/config/rig_config.h"
#include "rig_firmware/daemon/rig_daemon.h"

namespace vantage {
namespace {

constexpr std::chrono::milliseconds look_every(50);
constexpr std::chrono::seconds status_every(5);

struct Options {
    std::string config;
    std::uint64_t frames = 0;
    bool json = false;
};

nlohmann::json to_json(const Percentiles& p) {
    return {{"p50", p.p50}, {"p95", p.p95}, {"p99", p.p99}, {"max", p.max}};
}

nlohmann::json to_json(const std::string& rig, const DaemonStatus& status) {
    const RigCounters& c = status.publisher.counters;
    nlohmann::json hosts = nlohmann::json::array();
    for (const HostLinks::HostStatus& host : status.publisher.hosts)
        hosts.push_back({{"key", host.host_key},
                         {"attached", host.attached},
                         {"offered", host.counters.offered},
                         {"sent", host.counters.sent},
                         {"send_dropped", host.counters.send_dropped},
                         {"thinned", host.counters.thinned}});
    nlohmann::json source = nlohmann::json::object();
    for (const SourceCounter& counter : status.source_counters)
        source[counter.name] = counter.count;
    return {{"rig", rig},
            {"captured", c.captured},
            {"missed", c.missed},
            {"late", c.late},
            {"published", c.published},
            {"send_dropped", c.send_dropped},
            {"source", source},
            {"hosts", hosts},
            {"capture_ms", to_json(status.capture_ms)},
            {"rectify_ms", to_json(status.rectify_ms)},
            {"match_ms", to_json(status.match_ms)},
            {"pack_ms", to_json(status.pack_ms)}};
}

std::string status_line(const DaemonStatus& status) {
    const RigCounters& c = status.publisher.counters;
    return fmt::format(
        "captured {}, published {}, missed {}, late {}, dropped for slow hosts {}; ms (p50): "
        "rectify {:.1f}, match {:.1f}, pack {:.1f}",
        c.captured, c.published, c.missed, c.late, c.send_dropped, status.rectify_ms.p50,
        status.match_ms.p50, status.pack_ms.p50);
}

void run(const Options& options) {
    const RigConfig config = load_rig_config(options.config);
    StopSignal stop;
    RigDaemon daemon(config);
    for (const std::string& line : daemon.report()) log_info("{}: {}", config.name, line);

    MonotonicTime next_status = MonotonicClock::now() + status_every;
    while (daemon.running() && !stop.wait_for(look_every)) {
        const bool enough =
            options.frames > 0 && daemon.status().publisher.counters.published >= options.frames;
        if (enough) break;
        if (MonotonicClock::now() < next_status) continue;
        next_status += status_every;
        log_info("{}: {}", config.name, status_line(daemon.status()));
    }
    daemon.stop();
    daemon.rethrow_failure();
    const DaemonStatus status = daemon.status();
    log_info("{}: {}", config.name, status_line(status));
    if (options.json) std::cout << to_json(config.name, status).dump() << '\n';
}

}  // namespace

CommandEntry run_command_entry() {
    return {[](CLI::App& program) {
        auto options = std::make_shared<Options>();
        CLI::App* command =
            program.add_subcommand("run", "The rig daemon: capture, rectify, match, stream");
        command->add_option("--config", options->config, "rig.toml (see hw_config/rig.toml)")
            ->required();
        command->add_option("--frames", options->frames,
                            "End after so many published frames (default: on SIGINT or SIGTERM)");
        command->add_flag("--json", options->json, "Print the closing summary as JSON");
        command->callback([options] { run(*options); });
    }};
}

}  // namespace vantage
