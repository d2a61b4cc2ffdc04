#include <array>
#include <charconv>
#include <iostream>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/base/cli/version.h"
#include "common/base/error.h"
#include "common/config/endpoint.h"
#include "host_app/commands/rigs/rigs_commands.h"
#include "host_app/session/options/common_options.h"

namespace vantage {
namespace {

struct UpdateOptions {
    std::string stage;
    double wait_s = 3;
    bool json = false;
};

/// Parses a version: 0.2.0 is {0, 2, 0}.
std::array<int, 3> numbers_of(std::string_view text) {
    std::array<int, 3> numbers{};
    const char* at = text.data();
    const char* const end = at + text.size();
    for (int& number : numbers) {
        const auto [rest, error] = std::from_chars(at, end, number);
        if (error != std::errc() || rest == end || *rest != '.') break;
        at = rest + 1;
    }
    return numbers;
}

/// Compares a rig's version with this host's; empty if they are equal.
std::string difference(const RigStatus& rig) {
    const std::string& its = rig.health.program_version;
    if (!rig.connected) return "unknown: " + trouble_of(rig);
    if (its.empty()) return "older than this host, too old to report its version";
    if (its == version()) return "";
    return numbers_of(its) > numbers_of(version()) ? "newer than this host"
                                                   : "older than this host";
}

/// Returns the commands that update a rig, in order.
std::vector<std::string> mend(const StageConfig::Rig& rig) {
    const std::string host = parse_endpoint(rig.endpoint, "endpoint").host;
    return {fmt::format("ssh {} sudo apt-get update", host),
            fmt::format("ssh {} sudo apt-get install --yes 'vantage-rig={}*'", host, version())};
}

void run(const UpdateOptions& options) {
    const StageConfig stage = load_stage_config(options.stage);
    StopSignal stop;
    const ReceiverStatus status =
        gather_status(stage, options.wait_s, StatusCondition::all_answered, stop);
    nlohmann::ordered_json rigs = nlohmann::ordered_json::array();
    std::string text = fmt::format("this host: {}\n", version());
    std::size_t others = 0, unknown = 0;
    for (std::size_t i = 0; i < status.rigs.size(); ++i) {
        const RigStatus& rig = status.rigs[i];
        const std::string apart = difference(rig);
        nlohmann::ordered_json entry{{"name", rig.rig}, {"version", rig.health.program_version}};
        text += fmt::format("{}: {}{}\n", rig.rig, rig.health.program_version,
                            apart.empty()                        ? ", the same as this host"
                            : rig.health.program_version.empty() ? apart
                                                                 : ", " + apart);
        entry["same"] = apart.empty();
        if (!rig.connected) {
            ++unknown;
            entry["trouble"] = trouble_of(rig);
        } else if (!apart.empty()) {
            ++others;
            entry["run"] = mend(stage.rigs[i]);
            for (const std::string& line : mend(stage.rigs[i])) text += "    " + line + '\n';
        }
        rigs.push_back(std::move(entry));
    }
    if (options.json)
        std::cout << nlohmann::ordered_json{{"version", version()}, {"rigs", rigs}}.dump() << '\n';
    else
        std::cout << text;
    if (others > 0)
        fail(
            "{} of {} rigs run another version than this host; update one, check it (vantage rigs "
            "status), then the next{}",
            others, status.rigs.size(),
            unknown > 0 ? fmt::format("; {} more did not answer", unknown) : "");
    if (unknown > 0)
        fail("{} of {} rigs did not answer; see vantage rigs status", unknown, status.rigs.size());
}

}  // namespace

void add_rigs_update(CLI::App& rigs) {
    auto options = std::make_shared<UpdateOptions>();
    CLI::App* update = rigs.add_subcommand(
        "update",
        "List the rigs' versions and the commands that update them to this host's; exit with 1 if "
        "any differs");
    update->add_option("--stage", options->stage, stage_file_help)->required();
    update
        ->add_option("--wait", options->wait_s,
                     "Wait at most this many seconds for the rigs (default: 3)")
        ->check(CLI::Range(0.1, 3600.0));
    update->add_flag("--json", options->json, "Print the result as JSON");
    update->callback([options] { run(*options); });
}

}  // namespace vantage
