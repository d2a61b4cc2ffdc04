#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "common/base/cli/command.h"
#include "common/base/cli/line_input.h"
#include "common/base/cli/print_result.h"
#include "common/base/cli/stop_signal.h"
#include "common/base/error.h"
#include "common/base/files/folder.h"
#include "common/config/endpoint.h"
#include "common/pairing/pairing_place.h"
#include "common/wire/limits.h"
#include "common/wire/status_report.h"
#include "common/wire/zmq_helpers.h"
#include "host_app/commands/rigs/rigs_commands.h"
#include "host_app/setup/pairing_call.h"
#include "host_app/setup/rig_browser.h"
#include "host_app/setup/stage_file.h"

namespace vantage {
namespace {

struct SetupOptions {
    std::string stage;
    std::vector<std::string> rigs;
    double search_s = 4, wait_s = 20;
    bool add = false, check = false, json = false;
};

/// Returns the name of this computer in the characters that a pairing allows.
std::string own_name() {
    std::string name(max_name_chars + 1, '\0');
    if (::gethostname(name.data(), max_name_chars) != 0) name.clear();
    name.resize(name.find('\0') == std::string::npos ? 0 : name.find('\0'));
    std::erase_if(name, [](unsigned char c) { return !std::isalnum(c) && c != '-' && c != '.'; });
    return name.empty() ? "host" : name;
}

/// Parses "north", "10.0.0.5:5591" or "[fd00::1]".
Endpoint pairing_endpoint(const std::string& rig) {
    const bool has_port = !rig.ends_with(']') && rig.find(':') != std::string::npos;
    return parse_endpoint("tcp://" + rig + (has_port ? "" : ":" + std::to_string(pairing_port)),
                          "--rig");
}

/// The state of a setup session.
struct Session {
    const SetupOptions& options;
    StopSignal& stop;
    EventTeller teller;
    StageFile stage;
    LineInput input{STDIN_FILENO};
    bool may_add = options.add || !stage.is_there();

    bool knows(const std::string& rig) const {
        const auto& rigs = stage.config().rigs;
        return std::any_of(rigs.begin(), rigs.end(),
                           [&](const StageConfig::Rig& known) { return known.name == rig; });
    }
};

nlohmann::ordered_json to_json(const FoundRig& rig) {
    return {{"name", rig.name},
            {"host", rig.host},
            {"pairing_port", rig.pairing_port},
            {"stream_port", rig.stream_port}};
}

/// Searches the network and returns the rigs that are open for pairing.
std::vector<Endpoint> search(Session& session) {
    std::vector<FoundRig> found;
    try {
        found = find_rigs(std::chrono::milliseconds(std::lround(1000 * session.options.search_s)),
                          [&] { return session.stop.requested(); });
    } catch (const Error& error) {
        // The rigs in the stage file can still be checked.
        if (!session.stage.is_there()) throw;
        session.teller.tell({{"event", "search_failed"}, {"why", error.what()}},
                            fmt::format("{}.\n", error.what()));
        return {};
    }
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    std::string words = found.empty() ? "Found no rig on the network.\n" : "";
    std::vector<Endpoint> open;
    for (const FoundRig& rig : found) {
        all.push_back(to_json(rig));
        const char* state = "not open for pairing; run at the rig: sudo vantage-rig pair";
        if (session.knows(rig.name)) {
            state = rig.pairing_port == 0 ? "in this stage"
                                          : "in this stage; use --rig to pair with it again";
        } else if (rig.pairing_port != 0 && !session.may_add) {
            state = "open for pairing; use --add to add it to the stage";
        } else if (rig.pairing_port != 0) {
            state = "open for pairing";
            open.push_back(pairing_endpoint(fmt::format("{}:{}", rig.host, rig.pairing_port)));
        }
        words += fmt::format("{} at {}: {}\n", rig.name, rig.host, state);
    }
    session.teller.tell({{"event", "found"}, {"rigs", all}}, words);
    return open;
}

/// Returns why a rig cannot be added to the stage; empty if it can.
std::string fault_of(const Session& session, const PairOffer& offer) {
    const std::string file = session.stage.path().string();
    if (offer.stream_port == 0)
        return fmt::format(
            "{} streams on another port after every start; set a port in bind in [stream] of its "
            "rig.toml",
            offer.rig);
    for (const StageConfig::Rig& rig : session.stage.config().rigs)
        if (rig.name == offer.rig && rig.public_key != offer.public_key)
            return fmt::format(
                "{} has a rig '{}' with another key; if this is another rig, give it another "
                "'name' in its rig.toml; if it was reinstalled, remove its table from the stage "
                "file and use "
                "--add",
                file, offer.rig);
    if (!session.knows(offer.rig) && !session.may_add)
        return fmt::format("{} exists and is not changed; use --add to add {} to it", file,
                           offer.rig);
    return "";
}

void show_code(const Session& session, const PairOffer& rig, const Endpoint& endpoint,
               const std::string& code) {
    session.teller.tell({{"event", "code"}, {"code", code}, {"rig", rig.rig}},
                        fmt::format("\nThe rig '{}' at {} answers. The code is:\n\n    {}\n\n"
                                    "If the rig shows the same code, type it; otherwise type no: ",
                                    rig.rig, endpoint.host, code));
}

/// Pairs with a rig and returns it once both sides have confirmed the code; nothing if the program
/// is told to stop.
std::optional<PairOffer> pair_with(Session& session, const Endpoint& endpoint,
                                   const CurveKeys& keys) {
    PairingCall call(endpoint.text(), keys, own_name(), {});
    bool is_shown = false;
    while (!call.is_agreed()) {
        std::vector<zmq::pollitem_t> items{{call.socket().handle(), 0, ZMQ_POLLIN, 0}};
        if (!session.input.is_at_end())
            items.push_back({nullptr, session.input.fd(), ZMQ_POLLIN, 0});
        wait_for(items, StopSignal::look_period);
        if (session.stop.requested()) {
            call.refuse("setup was ended at the host");
            return std::nullopt;
        }
        call.turn(MonotonicClock::now());
        const std::optional<std::string> code = call.to_compare();
        if (code && !is_shown) {
            if (const std::string fault = fault_of(session, call.rig()); !fault.empty()) {
                call.refuse("the host does not accept this rig; see its message");
                fail("{}", fault);
            }
            show_code(session, call.rig(), endpoint, *code);
            is_shown = true;
        }
        const std::optional<std::string> line = session.input.take();
        if (!code) continue;
        if (line && is_same_code(*line, *code)) {
            call.confirm();
            session.teller.tell({{"event", "confirmed"}, {"rig", call.rig().rig}},
                                "Confirmed; waiting for the rig's side.\n");
        } else if (line) {
            call.refuse("the operator of the host found different codes");
            fail(
                "the codes of this host and {} differ, so the rig is not trusted: a third computer "
                "may intercept the connection; try again, and check the network if it repeats",
                call.rig().rig);
        } else if (session.input.is_at_end()) {
            call.refuse("nobody at the host can compare the codes");
            fail("standard input has ended, so nobody can compare the codes");
        }
    }
    return call.rig();
}

void pair(Session& session, const Endpoint& endpoint) {
    const std::optional<PairOffer> rig = pair_with(session, endpoint, session.stage.host_keys());
    if (!rig) return;
    const std::string stream = fmt::format("tcp://{}:{}", endpoint.host, rig->stream_port);
    const bool is_new = !session.knows(rig->rig);
    if (is_new) session.stage.add({rig->rig, stream, rig->public_key}, rig->rate_hz);
    session.teller.tell({{"event", "paired"},
                         {"rig", rig->rig},
                         {"endpoint", stream},
                         {"public_key", rig->public_key},
                         {"stage", session.stage.path().string()},
                         {"added", is_new}},
                        is_new ? fmt::format("Paired with '{}' and added it to {}.\n", rig->rig,
                                             session.stage.path().string())
                               : fmt::format("Paired with '{}', which is already in {}.\n",
                                             rig->rig, session.stage.path().string()));
}

void check(const Session& session) {
    const std::string file = session.stage.path().string();
    const ReceiverStatus status = gather_status(session.stage.config(), session.options.wait_s,
                                                StatusCondition::all_connected, session.stop);
    const std::vector<Finding> findings = findings_of(status, file);
    nlohmann::ordered_json rigs = nlohmann::ordered_json::array(), lacks = rigs;
    std::string words = fmt::format("\nThe rigs of {}:\n", file);
    for (const RigStatus& rig : status.rigs) {
        rigs.push_back(to_json(rig, status.rigs));
        words += rig.connected
                     ? fmt::format("{}: connected, {:g} Hz; {}; {}\n", rig.rig, rig.sync.rate_hz,
                                   clock_text(rig), health_text(rig.health))
                     : fmt::format("{}: not connected\n", rig.rig);
        for (const Finding& finding : findings) {
            if (finding.rig != rig.rig) continue;
            words += fmt::format("  {} {}\n", finding.blocks ? "!" : "-", finding.what);
            if (!finding.mend.empty()) words += fmt::format("      {}\n", finding.mend);
        }
    }
    std::size_t blocking = 0;
    for (const Finding& finding : findings) {
        lacks.push_back({{"rig", finding.rig},
                         {"blocks", finding.blocks},
                         {"what", finding.what},
                         {"mend", finding.mend}});
        blocking += finding.blocks ? 1 : 0;
    }
    if (blocking == 0)
        words += fmt::format("\nThe stage is ready: vantage live --stage {}\n", file);
    session.teller.tell({{"event", "checked"},
                         {"stage", file},
                         {"ready", blocking == 0},
                         {"rigs", rigs},
                         {"findings", lacks}},
                        words);
    if (blocking > 0)
        fail(
            "{} of the findings keep a rig from the stage; fix them, then run vantage setup "
            "--check",
            blocking);
}

void set_up(const SetupOptions& options) {
    StopSignal stop;
    Session session{options, stop, EventTeller(options.json),
                    StageFile(options.stage.empty() ? user_folder() / "stage.toml"
                                                    : std::filesystem::path(options.stage))};
    if (options.check && !session.stage.is_there())
        fail("there is no {} to check; run vantage setup to create it",
             session.stage.path().string());
    std::vector<Endpoint> to_pair;
    for (const std::string& rig : options.rigs) to_pair.push_back(pairing_endpoint(rig));
    if (options.rigs.empty() && !options.check) to_pair = search(session);
    for (const Endpoint& endpoint : to_pair)
        if (!stop.requested()) pair(session, endpoint);
    if (stop.requested()) return;
    if (!session.stage.is_there())
        fail(
            "found no rig to set up: run sudo vantage-rig pair at the rig, or name it with --rig "
            "HOST if the network has no multicast");
    check(session);
}

}  // namespace

CommandEntry setup_command_entry() {
    return {[](CLI::App& program) {
        auto options = std::make_shared<SetupOptions>();
        CLI::App* command = program.add_subcommand(
            "setup",
            "Set up a stage: find the rigs on the network, pair with those that are open for it "
            "(vantage-rig pair), write the stage file and check every rig; exit with 1 if a rig "
            "cannot send frames");
        command->add_option("--stage", options->stage,
                            "Write this stage file (default: ~/.config/vantage/stage.toml)");
        auto* rigs = command->add_option(
            "--rig", options->rigs,
            "Pair with the rig at HOST or HOST:PORT instead of searching; repeat the option for "
            "more rigs");
        command->add_flag("--add", options->add, "Add new rigs to a stage file that exists");
        command->add_flag("--check", options->check, "Only check the rigs of the stage")
            ->excludes(rigs);
        command->add_option("--search", options->search_s, "Search for rigs for this many seconds")
            ->check(CLI::Range(0.5, 600.0))
            ->capture_default_str();
        command
            ->add_option("--wait", options->wait_s,
                         "Wait at most this many seconds for the rigs to connect")
            ->check(CLI::Range(0.1, 3600.0))
            ->capture_default_str();
        command->add_flag("--json", options->json,
                          "Print events as lines of JSON: found, code, confirmed, paired, checked");
        command->callback([options] { set_up(*options); });
    }};
}

}  // namespace vantage
