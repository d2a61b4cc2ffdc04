#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/cli/command.h"
#include "common/base/cli/stop_signal.h"
#include "rig_firmware/clock/ptp_state_file.h"

namespace vantage {
namespace {

constexpr std::chrono::seconds ask_every(1);

struct PtpStateOptions {
    std::filesystem::path socket = ptp4l_socket, file;
    bool json = false;
};

void keep_state(const PtpStateOptions& options) {
    std::filesystem::path file = options.file;
    if (file.empty() && !options.json) file = ptp_state_file;
    std::error_code ignored;
    StopSignal stop;
    do {
        const std::optional<PtpState> state = read_ptp4l(options.socket);
        std::optional<PtpReading> reading;
        if (state) reading = {.ptp = *state, .kernel = read_kernel_clock()};
        const MonotonicTime now = MonotonicClock::now();
        if (options.json) std::cout << to_json(reading, now).dump() << std::endl;
        if (file.empty()) continue;
        if (reading)
            write_ptp_state(file, *reading, now);
        else
            std::filesystem::remove(file, ignored);
    } while (!stop.wait_for(ask_every));
    if (!file.empty()) std::filesystem::remove(file, ignored);
}

}  // namespace

CommandEntry ptp_state_command_entry() {
    return {[](CLI::App& program) {
        auto options = std::make_shared<PtpStateOptions>();
        CLI::App* command =
            program.add_subcommand("ptp-state",
                                   "Ask ptp4l every second for the state of the clock, for a "
                                   "daemon that has no access to ptp4l");
        command->add_option("--ptp4l", options->socket, "Ask at this management socket of ptp4l")
            ->capture_default_str();
        command->add_option(
            "--write", options->file,
            fmt::format("Write the latest answer to this file (JSON), and remove it while ptp4l "
                        "does not answer (default: {}; with --json: no file)",
                        ptp_state_file));
        command->add_flag("--json", options->json,
                          "Also print every answer as a line of JSON; port_state is null while "
                          "ptp4l does not answer");
        command->callback([options] { keep_state(*options); });
    }};
}

}  // namespace vantage
