#include <filesystem>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>

#include "common/base/command.h"
#include "common/base/stop_signal.h"
#include "rig_firmware/clock/ptp_state_file.h"

namespace vantage {
namespace {

constexpr std::chrono::seconds ask_every(1);

struct Options {
    std::filesystem::path socket = ptp4l_socket;
    std::filesystem::path file = ptp_state_file;
};

void keep_state(const Options& options) {
    std::error_code ignored;
    StopSignal stop;
    do {
        if (const std::optional<PtpState> state = read_ptp4l(options.socket))
            write_ptp_state(options.file, {.ptp = *state, .kernel = read_kernel_clock()},
                            MonotonicClock::now());
        else
            std::filesystem::remove(options.file, ignored);
    } while (!stop.wait_for(ask_every));
    std::filesystem::remove(options.file, ignored);
}

}  // namespace

CommandEntry ptp_state_command_entry() {
    return {[](CLI::App& program) {
        auto options = std::make_shared<Options>();
        CLI::App* command = program.add_subcommand(
            "ptp-state",
            "Ask ptp4l every second how the clock stands, for a daemon that may not ask itself");
        command->add_option("--ptp4l", options->socket, "ptp4l's management socket")
            ->capture_default_str();
        command
            ->add_option("--write", options->file,
                         "File for the newest answer (JSON); none where ptp4l gives none")
            ->capture_default_str();
        command->callback([options] { keep_state(*options); });
    }};
}

}  // namespace vantage
