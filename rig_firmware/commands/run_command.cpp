#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/base/cli/command.h"
#include "common/base/cli/stop_signal.h"
#include "common/base/log.h"
#include "common/config/endpoint.h"
#include "common/config/rig_config.h"
#include "common/pairing/pairing_place.h"
#include "common/wire/status_report.h"
#include "rig_firmware/commands/help_words.h"
#include "rig_firmware/daemon/rig_daemon.h"
#include "rig_firmware/daemon/service_notifier.h"
#include "rig_firmware/pairing/service_announcement.h"

namespace vantage {
namespace {

constexpr std::chrono::seconds status_every(5);
/// A thread that has not passed its loop for this long counts as stuck. The limit covers the
/// slowest healthy case: matching one frame on a busy processor.
constexpr std::chrono::seconds stuck_after(15);

struct RunOptions {
    std::string config;
    std::uint64_t frames = 0;
    bool json = false;
};

nlohmann::ordered_json to_json(const std::string& rig, const DaemonStatus& status) {
    nlohmann::ordered_json hosts = nlohmann::ordered_json::array();
    for (const HostLinks::HostStatus& host : status.publisher.hosts)
        hosts.push_back({{"key", host.host_key},
                         {"attached", host.attached},
                         {"offered", host.counters.offered},
                         {"sent", host.counters.sent},
                         {"send_dropped", host.counters.send_dropped},
                         {"skipped", host.counters.skipped},
                         {"thinned", host.counters.skipped},  // old name
                         {"fetched", host.fetched}});
    nlohmann::ordered_json source = nlohmann::ordered_json::object();
    for (const SourceCounter& counter : status.source_counters)
        source[counter.name] = counter.count;
    nlohmann::ordered_json summary{{"rig", rig}};
    summary.update(to_json(status.publisher.counters));
    summary.update({{"source", source},
                    {"sync", to_json(status.sync)},
                    {"hosts", hosts},
                    {"refused_messages", status.publisher.malformed},
                    {"refused_fetches", status.publisher.refused_fetches},
                    {"refused_connections", status.publisher.refused_connections},
                    {"keeps", status.keeps},
                    {"kept_files_erased", status.kept_files_erased},
                    {"capture_ms", to_json(status.capture_ms)},
                    {"rectify_ms", to_json(status.rectify_ms)},
                    {"match_ms", to_json(status.match_ms)},
                    {"pack_ms", to_json(status.pack_ms)},
                    {"latency_ms", to_json(status.latency_ms)}});
    return summary;
}

/// Prints the status of the daemon: frame counts so far, with the rates since the last line.
class StatusLines {
  public:
    std::string next(const DaemonStatus& status) {
        const RigCounters& c = status.publisher.counters;
        const MonotonicTime now = MonotonicClock::now();
        const double rate_hz = static_cast<double>(c.published - published_) /
                               std::chrono::duration<double>(now - time_).count();
        time_ = now;
        published_ = c.published;
        const std::string pulses = pulse_text(status.sync);
        return fmt::format(
                   "{:.1f} frames/s; captured {}, published {}, missed {}, late {}, dropped for "
                   "slow "
                   "hosts "
                   "{}; ms (p50): capture {:.1f}, rectify {:.1f}, match {:.1f}, pack {:.1f}, "
                   "exposure to "
                   "publishing {:.1f}",
                   rate_hz, c.captured, c.published, c.missed, c.late, c.send_dropped,
                   status.capture_ms.p50, status.rectify_ms.p50, status.match_ms.p50,
                   status.pack_ms.p50, status.latency_ms.p50) +
               (status.starting.empty() ? "" : "; " + status.starting) +
               (pulses.empty() ? "" : "; " + pulses) +
               (status.keeps.empty() ? "" : "; " + status.keeps);
    }

  private:
    MonotonicTime time_ = MonotonicClock::now();
    std::uint64_t published_ = 0;
};

/// Feeds the service manager's watchdog while every thread of the daemon passes its loop. `stuck`
/// holds the name of the thread that was stuck at the last call.
void tell(ServiceNotifier& service, const RigDaemon& daemon, std::string& stuck) {
    const DaemonStatus status = daemon.status();
    const std::string published =
        status.starting.empty()
            ? fmt::format("{} frames published", status.publisher.counters.published)
            : status.starting;
    const std::string worker = daemon.stuck_worker(stuck_after);
    if (worker.empty()) {
        service.alive(published);
    } else {
        service.stuck(fmt::format("the thread '{}' is stuck; {}", worker, published));
        if (worker != stuck)
            log_error("the thread '{}' has not come round for {} s; systemd's watchdog is not fed",
                      worker, stuck_after.count());
    }
    stuck = worker;
}

void run(const RunOptions& options) {
    const RigConfig config = load_rig_config(options.config);
    StopSignal stop;
    RigDaemon daemon(config, options.frames);
    std::set<std::string> said;
    const auto say_new_lines = [&] {
        for (const std::string& line : daemon.report())
            if (said.insert(line).second) log_info("{}: {}", config.name, line);
    };
    say_new_lines();

    std::optional<ServiceAnnouncement> announcement;
    if (const Endpoint bound = parse_endpoint(daemon.endpoint(), "stream.bind"); !bound.loopback)
        announcement.emplace(config.name, stream_service, std::stoi(bound.port));

    ServiceNotifier service;
    service.ready();
    StatusLines lines;
    std::string stuck;
    bool is_started = false;
    MonotonicTime next_status = MonotonicClock::now() + status_every;
    while (daemon.running() && !stop.wait_for(StopSignal::look_period)) {
        tell(service, daemon, stuck);
        // The report names the GPU only once its shaders are compiled.
        if (!is_started && daemon.status().starting.empty()) {
            is_started = true;
            say_new_lines();
        }
        if (MonotonicClock::now() < next_status) continue;
        next_status += status_every;
        log_info("{}: {}", config.name, lines.next(daemon.status()));
    }
    service.stopping();
    daemon.stop();
    daemon.rethrow_failure();
    const DaemonStatus status = daemon.status();
    log_info("{}: {}", config.name, lines.next(status));
    if (options.json) std::cout << to_json(config.name, status).dump() << '\n';
}

}  // namespace

CommandEntry run_command_entry() {
    return {[](CLI::App& program) {
        auto options = std::make_shared<RunOptions>();
        CLI::App* command =
            program.add_subcommand("run", "Run the rig daemon: capture, rectify, match, stream");
        command->add_option("--config", options->config, rig_file_help)->required();
        command->add_option("--frames", options->frames,
                            "End after this many published frames (default: on SIGINT or SIGTERM)");
        command->add_flag("--json", options->json, "Print the closing summary as JSON");
        command->callback([options] { run(*options); });
    }};
}

}  // namespace vantage
