#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "common/base/cli/command.h"
#include "common/base/cli/line_input.h"
#include "common/base/cli/print_result.h"
#include "common/base/cli/stop_signal.h"
#include "common/base/error.h"
#include "common/base/time/time.h"
#include "common/config/endpoint.h"
#include "common/pairing/pairing_place.h"
#include "common/wire/zmq_helpers.h"
#include "rig_firmware/pairing/paired_files.h"
#include "rig_firmware/pairing/pairing_socket.h"
#include "rig_firmware/pairing/pairing_window.h"
#include "rig_firmware/pairing/service_announcement.h"

namespace vantage {
namespace {

struct PairOptions {
    std::filesystem::path config = "/etc/vantage/rig.toml";
    std::string bind = fmt::format("tcp://*:{}", pairing_port);
    double minutes = 5;
    int attempts = 3;
    bool json = false;
};

int port_of(const std::string& endpoint) {
    const std::string port = parse_endpoint(endpoint, "bind").port;
    return port == "*" ? 0 : std::stoi(port);
}

void tell_open(const EventTeller& teller, const PairedFiles& files, const std::string& endpoint,
               const PairOptions& options) {
    teller.tell(
        {{"event", "open"}, {"rig", files.config().name}, {"endpoint", endpoint}},
        fmt::format("{} is open for pairing at port {} for {:g} minutes. At the host: "
                    "vantage setup\n",
                    files.config().name, parse_endpoint(endpoint, "--bind").port, options.minutes));
}

void tell_code(const EventTeller& teller, const RigPairing& pairing, const std::string& address) {
    teller.tell({{"event", "code"},
                 {"code", *pairing.code()},
                 {"host", pairing.host().host},
                 {"address", address}},
                fmt::format("\nThe host '{}' at {} wants to pair. The code here:\n\n    {}\n\nType "
                            "the code if vantage setup shows the very same, or no: ",
                            pairing.host().host, address, *pairing.code()));
}

void tell_paired(const EventTeller& teller, const PairedFiles& files, const PairReveal& host,
                 const std::vector<std::string>& changes, const PairOptions& options) {
    std::string words = fmt::format("Paired with '{}', whose key now is in {}.\n", host.host,
                                    files.hosts_file().string());
    if (!changes.empty()) {
        words += fmt::format("In [stream] of {} now stands:\n", options.config.string());
        for (const std::string& change : changes) words += fmt::format("    {}\n", change);
        words += "The daemon takes it up with: sudo systemctl restart vantage-rig\n";
    }
    teller.tell({{"event", "paired"},
                 {"host", host.host},
                 {"public_key", host.public_key},
                 {"changed", changes}},
                words);
}

/// Handles a line that the operator typed while a pairing code is shown.
void take_answer(const std::string& line, PairingWindow& window, PairingSocket& socket) {
    const RigPairing* const pairing = window.to_compare();
    // A line that was typed before the code was shown answers nothing.
    if (!pairing) return;
    socket.send(is_same_code(line, *pairing->code()) ? window.confirm()
                                                     : window.reject(MonotonicClock::now()));
}

void pair(const PairOptions& options) {
    StopSignal stop;
    const EventTeller teller(options.json);
    PairedFiles files(options.config);
    PairingSocket socket(options.bind);
    const Endpoint bound = parse_endpoint(socket.endpoint(), "--bind");
    PairingWindow::Limits limits;
    limits.open_for = from_s(60 * options.minutes);
    limits.attempts = options.attempts;
    PairOffer offer;
    offer.rig = files.config().name;
    offer.stream_port = port_of(files.config().stream.bind);
    offer.rate_hz = files.config().source.rate_hz;
    PairingWindow window(files.own_keys(), offer, limits, MonotonicClock::now());
    std::optional<ServiceAnnouncement> announcement;
    if (!bound.loopback)
        announcement.emplace(files.config().name, pairing_service, port_of(socket.endpoint()));
    tell_open(teller, files, socket.endpoint(), options);

    LineInput input(STDIN_FILENO);
    std::string shown;
    while (!window.is_closed() && !stop.requested()) {
        std::vector<zmq::pollitem_t> items{{socket.socket().handle(), 0, ZMQ_POLLIN, 0}};
        if (!input.is_at_end()) items.push_back({nullptr, input.fd(), ZMQ_POLLIN, 0});
        wait_for(items, StopSignal::look_period);
        socket.serve(window, MonotonicClock::now());
        socket.send(window.tick(MonotonicClock::now()));
        if (const std::string failure = window.take_failure(); !failure.empty())
            teller.tell({{"event", "failed"}, {"why", failure}},
                        fmt::format("\nNot paired: {}.\n", failure));
        const RigPairing* const pairing = window.to_compare();
        const std::string code = pairing ? *pairing->code() : "";
        if (pairing && code != shown) tell_code(teller, *pairing, socket.peer_address());
        shown = code;
        if (const auto line = input.take()) take_answer(*line, window, socket);
        if (input.is_at_end() && window.to_compare())
            fail("nobody is at the standard input to compare the codes");
    }
    if (!window.paired()) fail("{}", window.is_closed() ? window.why_closed() : "not paired");
    tell_paired(teller, files, *window.paired(), files.admit(*window.paired(), !bound.loopback),
                options);
}

}  // namespace

CommandEntry pair_command_entry() {
    return {[](CLI::App& program) {
        auto options = std::make_shared<PairOptions>();
        CLI::App* command = program.add_subcommand(
            "pair",
            "Open this rig for pairing with a host that runs vantage setup: both show a code, "
            "which you compare and type at both ends. Keys and the list of hosts are stored beside "
            "rig.toml and entered there");
        command->add_option("--config", options->config, "rig.toml")->capture_default_str();
        command
            ->add_option("--bind", options->bind,
                         "Listen for hosts on this endpoint while the rig is open")
            ->capture_default_str();
        command
            ->add_option("--minutes", options->minutes, "Keep the rig open for this many minutes")
            ->check(CLI::Range(0.01, 60.0))
            ->capture_default_str();
        command
            ->add_option("--attempts", options->attempts, "Close after this many failed attempts")
            ->check(CLI::Range(1, 10))
            ->capture_default_str();
        command->add_flag("--json", options->json,
                          "Print events as lines of JSON: open, code, failed, paired");
        command->callback([options] { pair(*options); });
    }};
}

}  // namespace vantage
