#include <memory>

#include <CLI/CLI.hpp>

#include "common/base/cli/command.h"
#include "host_app/commands/live_session.h"
#include "host_app/session/options/help_words.h"

namespace vantage {

CommandEntry live_command_entry() {
    return {[](CLI::App& program) {
        auto options = std::make_shared<LiveOptions>();
        CLI::App* command = program.add_subcommand(
            "live", "Connect to the rigs of a stage, fuse, fly, put out; ends with a summary");
        command->add_option("--stage", options->stage, stage_file_help)->required();
        options->show.add_to(*command, "the stage's");
        CLI::Option* take = command->add_option(
            "--take", options->take,
            "Record what the rigs send from the start (.mkv; see vantage take); in "
            "a window the key T ends it and begins another");
        command
            ->add_option("--takes", options->takes,
                         "Folder of the takes that the key T begins, named for the time (default: "
                         "where the program was started)")
            ->excludes(take);
        command
            ->add_option("--pre-roll", options->pre_roll_s,
                         "Seconds that a take begun with the key T begins before it")
            ->check(CLI::Range(0.0, 120.0))
            ->capture_default_str();
        command
            ->add_option("--wait", options->wait_s,
                         "With --headless: seconds that the rigs may take to come")
            ->check(CLI::Range(0.1, 3600.0))
            ->capture_default_str();
        command
            ->add_option("--past-mb", options->past_mb,
                         "Memory for the newest frames, to go back to them; 0: no way back")
            ->check(CLI::Range(0.0, 1e6))
            ->capture_default_str();
        command->footer(
            "Without --headless a window opens: fly with mouse and keyboard, F1 helps. The summary "
            "goes to stdout,\nthe log to stderr. Ctrl-C ends in order: files are finished, the "
            "summary is printed. An output that\nfails does not end the programme; the exit status "
            "is 1 then.\n\nWhat the summary's words mean:\n" +
            counters_legend());
        command->callback([options] { run_live_session(*options); });
    }};
}

}  // namespace vantage
