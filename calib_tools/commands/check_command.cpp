#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>

#include "calib_tools/commands/snapshots.h"
#include "calib_tools/health/health_report.h"
#include "calib_tools/report/calibration_text.h"
#include "common/base/cli/command.h"
#include "common/base/error.h"
#include "common/base/log.h"

namespace vantage {
namespace {

struct CheckOptions {
    std::vector<std::string> rigs;
    LiveOption live;
    std::string html, history;
    long long instant = -1;
    bool json = false;
};

void run(const CheckOptions& options) {
    // Read before the long computation, so that a damaged history fails at once.
    const std::vector<PastCheck> past =
        options.history.empty() ? std::vector<PastCheck>{} : load_history(options.history);
    const std::vector<RigSnapshot> rigs =
        take_snapshots(parse_rig_folders(options.rigs), options.live, options.instant);
    const StageHealth health = check_stage(rigs);
    const std::string date = date_now();
    if (!options.html.empty()) {
        health_page(health, rigs, past, date).save(options.html);
        log_info("{} written", options.html);
    }
    if (!options.history.empty()) append_history(options.history, past, past_check(health, date));
    if (options.json)
        std::cout << to_json(health, date).dump(2) << '\n';
    else
        std::cout << describe(health);
    if (health.verdict() == Verdict::unknown)
        throw Undecided(
            fmt::format("the stage's health is unknown ({}): film something with texture that "
                        "neighbouring rigs see both",
                        fmt::join(health.not_known(), "; ")));
    if (health.verdict() == Verdict::bad)
        fail("the stage is bad: {}", fmt::join(health.sentences_of(Verdict::bad), "; "));
}

}  // namespace

CommandEntry check_command_entry() {
    return {[](CLI::App& program) {
        CLI::App* command = program.add_subcommand(
            "check",
            "Check how well a stage still fits its calibration, without a board; exit with 0 for "
            "good and warn, 1 for bad, 3 if the pictures show too little to decide");
        const auto options = std::make_shared<CheckOptions>();
        command
            ->add_option("--rig", options->rigs,
                         "Folder of a rig, given as NAME=FOLDER, with calibration.yaml, left*N.png "
                         "and right*N.png, raw pictures of anything on the stage; with --live a "
                         "calibration file is enough; repeat the option for each rig")
            ->required();
        options->live.add_to(*command);
        command->add_option("--instant", options->instant,
                            "Use the pictures with this number (default: each rig's first)");
        command->add_option("--html", options->html, "Write a report for a browser to this file");
        command->add_option(
            "--history", options->history,
            "Append the values of this check to this file, one line of JSON per check");
        command->add_flag("--json", options->json, "Print the result as JSON");
        command->callback([options] { run(*options); });
    }};
}

}  // namespace vantage
