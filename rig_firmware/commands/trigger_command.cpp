#include <iostream>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/base/cli/command.h"
#include "common/base/cli/stop_signal.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/config/rig_config.h"
#include "common/wire/status_report.h"
#include "rig_firmware/commands/help_words.h"
#include "rig_firmware/trigger/pulse_sender.h"

namespace vantage {
namespace {

struct TriggerOptions {
    std::string config;
    std::uint64_t count = 0;
    bool pretended = false;
    bool json = false;
};

void run(const TriggerOptions& options) {
    RigConfig config = load_rig_config(options.config);
    if (options.pretended) {
        config.trigger.pretended = true;
        config.trigger.role = "lead";
    }
    if (config.trigger.role != "lead")
        fail(
            "{} has the trigger role '{}': pulses are sent by the role 'lead', or without a line "
            "by --pretended",
            options.config, config.trigger.role);
    StopSignal stop;
    PulseSender sender(config.trigger, config.source.rate_hz);
    for (const std::string& line : sender.report()) log_info("{}: {}", config.name, line);
    sender.start(0);
    constexpr std::chrono::milliseconds progress_period(5);
    PulseStatus status = sender.status();
    while (status.sent + status.skipped < options.count && !stop.wait_for(progress_period)) {
        sender.rethrow_failure();
        status = sender.status();
    }
    sender.stop();
    sender.rethrow_failure();
    status = sender.status();
    if (options.json) {
        std::cout << nlohmann::ordered_json{{"rig", config.name},
                                            {"rate_hz", config.source.rate_hz},
                                            {"sent", status.sent},
                                            {"skipped", status.skipped},
                                            {"clock_steps", status.clock_steps},
                                            {"last_index", status.last_index},
                                            {"lateness_us", to_json(status.lateness_us)},
                                            {"width_error_us", to_json(status.width_error_us)},
                                            {"report", sender.report()}}
                         .dump()
                  << '\n';
        return;
    }
    std::cout << fmt::format(
        "{} pulses sent, {} skipped; lateness us p50 {:.1f}, p99 {:.1f}, max {:.1f}; width error "
        "us p50 {:.1f}, p99 {:.1f}, max {:.1f}\n",
        status.sent, status.skipped, status.lateness_us.p50, status.lateness_us.p99,
        status.lateness_us.max, status.width_error_us.p50, status.width_error_us.p99,
        status.width_error_us.max);
}

}  // namespace

CommandEntry trigger_command_entry() {
    return {[](CLI::App& program) {
        auto options = std::make_shared<TriggerOptions>();
        CLI::App* command = program.add_subcommand(
            "trigger", "Send trigger pulses only, and print how late they were");
        command->add_option("--config", options->config, rig_file_help)->required();
        command->add_option("--count", options->count, "Send this many pulses")
            ->required()
            ->check(CLI::PositiveNumber);
        command->add_flag("--pretended", options->pretended,
                          "Send no pulse to a GPIO line, but measure the timing of this computer");
        command->add_flag("--json", options->json, "Print the result as JSON");
        command->callback([options] { run(*options); });
    }};
}

}  // namespace vantage
