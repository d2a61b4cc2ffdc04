#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "common/base/cli/command.h"
#include "common/base/cli/stop_signal.h"
#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/log.h"
#include "common/config/endpoint.h"
#include "host_app/relay/rig_relay.h"

namespace vantage {
namespace {

/// Period at which the relay collects the rigs' status.
constexpr std::chrono::milliseconds status_period{200};

struct RelayOptions {
    std::string stage, rigs_file;
    RigRelay::Settings relay;
    bool json = false;
};

std::string host_name() {
    char name[256] = "localhost";
    return ::gethostname(name, sizeof name - 1) == 0 ? name : "localhost";
}

/// Formats the [[rigs]] entries for the stage files of this relay's hosts.
std::string stage_entries(const std::vector<RigRelay::Rig>& rigs, const std::string& listen) {
    std::string text;
    for (const RigRelay::Rig& rig : rigs) {
        Endpoint endpoint = parse_endpoint(rig.endpoint, "endpoint");
        if (parse_endpoint(listen, "--listen").host == "*") endpoint.host = host_name();
        text +=
            fmt::format("[[rigs]]\nname = \"{}\"\nendpoint = \"{}\"\n", rig.name, endpoint.text());
        if (!rig.public_key.empty()) text += fmt::format("public_key = \"{}\"\n", rig.public_key);
        text += "\n";
    }
    return text;
}

nlohmann::ordered_json to_json(const RigRelay::Rig& rig) {
    nlohmann::ordered_json json{{"name", rig.name},           {"endpoint", rig.endpoint},
                                {"connected", rig.connected}, {"trouble", rig.trouble},
                                {"frames", rig.frames},       {"bytes", rig.bytes},
                                {"dropped", rig.dropped},     {"undecodable", rig.undecodable}};
    json["hosts"] = nlohmann::ordered_json::array();
    for (const HostLinks::HostStatus& host : rig.hosts)
        json["hosts"].push_back({{"key", host.host_key},
                                 {"attached", host.attached},
                                 {"offered", host.counters.offered},
                                 {"sent", host.counters.sent},
                                 {"send_dropped", host.counters.send_dropped},
                                 {"skipped", host.counters.skipped},
                                 {"thinned", host.counters.skipped}});  // old name
    return json;
}

void print(const std::vector<RigRelay::Rig>& rigs) {
    for (const RigRelay::Rig& rig : rigs) {
        std::cout << fmt::format("{}: {} frames, {:.1f} MB, {} dropped before the relay\n",
                                 rig.name, rig.frames, static_cast<double>(rig.bytes) / 1e6,
                                 rig.dropped);
        for (const HostLinks::HostStatus& host : rig.hosts)
            std::cout << fmt::format("    {}: {} of {} sent, {} dropped, {} not requested\n",
                                     host.host_key.empty() ? "host without key" : host.host_key,
                                     host.counters.sent, host.counters.offered,
                                     host.counters.send_dropped, host.counters.skipped);
    }
}

void run(const RelayOptions& options) {
    // It must exist before the relay's threads, so that it receives the signals.
    StopSignal stop;
    const RigRelay relay(load_stage_config(options.stage), options.relay);
    const std::vector<RigRelay::Rig> rigs = relay.status();
    const std::string entries = stage_entries(rigs, options.relay.listen);
    if (options.rigs_file.empty()) {
        log_info("the rigs for the stage files of this relay's hosts:");
        fmt::print(stderr, "{}\n", entries);
    } else {
        write_text_atomically(options.rigs_file, entries);
    }
    while (!stop.wait_for(status_period)) (void)relay.status();
    const std::vector<RigRelay::Rig> ended = relay.status();
    if (!options.json) {
        print(ended);
        return;
    }
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const RigRelay::Rig& rig : ended) all.push_back(to_json(rig));
    std::cout << nlohmann::ordered_json{{"rigs", all}}.dump() << '\n';
}

}  // namespace

CommandEntry relay_command_entry() {
    return {[](CLI::App& program) {
        auto options = std::make_shared<RelayOptions>();
        CLI::App* relay = program.add_subcommand(
            "relay",
            "Receive the rigs' frames once and serve them unchanged to several hosts; the hosts' "
            "stage files name the relay instead of the rigs");
        relay->add_option("--stage", options->stage, "Stage file with the rigs themselves (TOML)")
            ->required();
        relay
            ->add_option(
                "--listen", options->relay.listen,
                "Serve the first rig on this endpoint, such as tcp://*:5700, and the next rigs on "
                "the ports that follow")
            ->required();
        relay->add_option("--authorized-hosts", options->relay.authorized_hosts,
                          "Serve only hosts whose public keys are in this file, one per line; "
                          "required beyond loopback");
        relay
            ->add_option("--queue-frames", options->relay.queue_frames,
                         "Queue at most this many frames of a rig for each host; older ones are "
                         "dropped and counted")
            ->check(CLI::Range(1, 1000))
            ->capture_default_str();
        relay->add_option("--rigs-file", options->rigs_file,
                          "Write the [[rigs]] entries for the hosts' stage files to this file "
                          "(default: to the log)");
        relay->add_flag("--json", options->json, "Print the frames' account at the end as JSON");
        relay->callback([options] { run(*options); });
    }};
}

}  // namespace vantage
