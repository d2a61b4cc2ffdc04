#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/base/cli/command.h"
#include "common/base/cli/stop_signal.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/time/time.h"
#include "common/wire/status_report.h"
#include "rig_firmware/trigger/bar_driver.h"

namespace vantage {
namespace {

struct SyncBarOptions {
    std::string chip;
    std::vector<std::string> lines;
    int leds = 12, priority = 60;
    double step_us = 127, spin_us = 0, seconds = 0;
    bool active_low = false, pretended = false, json = false;
};

/// Default lines of the 40-pin header: those that neither the pulses (GPIO17) nor I2C, SPI and UART
/// use.
std::vector<std::string> usual_lines(int leds) {
    std::vector<std::string> lines = {"GPIO5",  "GPIO6",  "GPIO12", "GPIO13", "GPIO16", "GPIO19",
                                      "GPIO20", "GPIO21", "GPIO22", "GPIO23", "GPIO24", "GPIO25"};
    if (static_cast<std::size_t>(leds) > lines.size())
        fail("{} LEDs need {} lines, and {} are known: name them with --lines", leds, leds,
             lines.size());
    lines.resize(static_cast<std::size_t>(leds));
    return lines;
}

std::unique_ptr<BarLines> open_lines(const SyncBarOptions& options) {
    if (options.pretended) return pretend_bar_lines();
    if (options.chip.empty())
        fail(
            "on which lines? give --chip, the label of a GPIO chip (vantage-rig probe lists them)");
    const std::vector<std::string> lines =
        options.lines.empty() ? usual_lines(options.leds) : options.lines;
    if (lines.size() != static_cast<std::size_t>(options.leds))
        fail("{} LEDs need as many lines, and --lines names {}", options.leds, lines.size());
    return open_bar_lines(options.chip, lines, options.active_low);
}

void run(const SyncBarOptions& options) {
    const SyncBar bar(options.leds, from_us(options.step_us));
    StopSignal stop;
    BarDriver driver(bar, open_lines(options), from_us(options.spin_us), options.priority);
    for (const std::string& line : driver.report()) log_info("{}", line);
    constexpr std::chrono::milliseconds check_period(20);
    const MonotonicTime end = MonotonicClock::now() + from_us(1e6 * options.seconds);
    while (!stop.wait_for(check_period) && (options.seconds == 0 || MonotonicClock::now() < end))
        driver.rethrow_failure();
    driver.stop();
    driver.rethrow_failure();
    const BarStatus status = driver.status();
    if (options.json)
        std::cout << nlohmann::ordered_json{{"leds", options.leds},
                                            {"step_us", options.step_us},
                                            {"shown", status.shown},
                                            {"skipped", status.skipped},
                                            {"lateness_us", to_json(status.lateness_us)},
                                            {"report", driver.report()}}
                         .dump()
                  << '\n';
    else
        std::cout << fmt::format(
            "{} steps shown, {} skipped; lateness us p50 {:.1f}, p99 {:.1f}, max {:.1f}\n",
            status.shown, status.skipped, status.lateness_us.p50, status.lateness_us.p99,
            status.lateness_us.max);
}

}  // namespace

CommandEntry sync_bar_command_entry() {
    return {[](CLI::App& program) {
        auto options = std::make_shared<SyncBarOptions>();
        CLI::App* command = program.add_subcommand(
            "sync-bar",
            "Count on a bar of LEDs at GPIO lines, for vantage-calib sync, until Ctrl-C");
        command->add_option("--chip", options->chip,
                            "Set the label of the GPIO chip: pinctrl-rp1 on a Raspberry Pi 5");
        command
            ->add_option("--lines", options->lines,
                         "Set the lines by name, that of the fastest LED first: GPIO5,GPIO6,... "
                         "(default: 12 lines that a rig does not use otherwise)")
            ->delimiter(',');
        command->add_option("--leds", options->leds, "Set the number of LEDs of the bar")
            ->check(CLI::Range(SyncBar::least_leds, SyncBar::most_leds))
            ->capture_default_str();
        command
            ->add_option("--step-us", options->step_us, "Set the time of one step in microseconds")
            ->check(CLI::Range(10.0, 1e6))
            ->capture_default_str();
        command->add_flag("--active-low", options->active_low,
                          "Drive LEDs that are lit at the low level");
        command
            ->add_option("--seconds", options->seconds,
                         "End after this many seconds (default: Ctrl-C)")
            ->check(CLI::Range(0.0, 1e6));
        command
            ->add_option(
                "--spin-us", options->spin_us,
                "Wait busily for this many microseconds before every step, against late wake-ups")
            ->check(CLI::Range(0.0, 1e4))
            ->capture_default_str();
        command
            ->add_option("--priority", options->priority, "Set the SCHED_FIFO priority; 0 is none")
            ->check(CLI::Range(0, 99))
            ->capture_default_str();
        command->add_flag("--pretended", options->pretended,
                          "Use no GPIO lines, but measure the timing of this computer");
        command->add_flag("--json", options->json, "Print the result as JSON");
        command->callback([options] { run(*options); });
    }};
}

}  // namespace vantage
