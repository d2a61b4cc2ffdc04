#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <unistd.h>

#include "common/base/cli/command.h"
#include "common/base/cli/stop_signal.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "host_app/control/hid/jog_devices.h"
#include "host_app/control/hid/simulated_wheel.h"
#include "host_app/session/options/common_options.h"

namespace vantage {
namespace {

struct JogOptions {
    std::string wheels;
    bool json = false, all = false, raw = false;
    double seconds = 0;
    std::uint64_t events = 0;
};

const char* name_of(JogTransport transport) {
    return transport == JogTransport::hidraw ? "hidraw" : "evdev";
}

/// Opens and closes a device; returns why it cannot be used, or nothing.
std::string fault_of(JogBus& bus, const JogPlace& place) {
    try {
        bus.open(place);
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

void print_places(const std::vector<JogPlace>& places, bool json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const JogPlace& place : places) {
        if (json)
            list.push_back({{"device", to_text(place.id)},
                            {"name", place.name},
                            {"path", place.path},
                            {"transport", name_of(place.transport)},
                            {"interface", place.interface_number},
                            {"usage_page", place.usage_page},
                            {"usage", place.usage}});
        else
            std::cout << fmt::format("{}  {}  {}  {}\n", to_text(place.id), place.path,
                                     name_of(place.transport), place.name);
    }
    if (json)
        std::cout << nlohmann::ordered_json{{"devices", list}}.dump() << '\n';
    else if (places.empty())
        std::cout << "this computer has no HID or input device (hidraw, evdev)\n";
}

void list(const JogOptions& options) {
    const std::vector<WheelProfile> profiles = load_all_wheel_profiles(options.wheels);
    const std::unique_ptr<JogBus> bus = make_system_jog_bus();
    const std::vector<JogPlace> places = bus->list();
    if (options.all) {
        print_places(places, options.json);
        return;
    }
    nlohmann::ordered_json controllers = nlohmann::ordered_json::array();
    for (const ReadableJog& jog : readable_jogs(places, profiles)) {
        const std::string fault = fault_of(*bus, jog.place);
        controllers.push_back({{"name", jog.model},
                               {"device", to_text(jog.place.id)},
                               {"path", jog.place.path},
                               {"serial", jog.place.serial},
                               {"usable", fault.empty()},
                               {"fault", fault}});
    }
    if (options.json) {
        std::cout << nlohmann::ordered_json{{"controllers", controllers}}.dump() << '\n';
        return;
    }
    for (const nlohmann::ordered_json& c : controllers)
        std::cout << fmt::format("{}  {}  {}  {}\n", c["device"].get<std::string>(),
                                 c["path"].get<std::string>(), c["name"].get<std::string>(),
                                 c["usable"] ? "ready" : c["fault"].get<std::string>());
    if (controllers.empty())
        std::cout << "no jog controller is connected; `vantage jog list --all` shows every device, "
                     "described_wheel.toml.example (hw_config/jog; installed: "
                     "/usr/share/doc/vantage/examples/jog) shows how to describe one, and `vantage "
                     "jog simulate` simulates one\n";
}

const char* name_of(JogKind kind) {
    switch (kind) {
        case JogKind::step:
            return "step";
        case JogKind::axis:
            return "axis";
        case JogKind::button:
            break;
    }
    return "button";
}

std::string for_people(const DeckEvent& event) {
    const std::string device = event.profile->name;
    const std::string bytes = fmt::format("{:02x}", fmt::join(event.report, " "));
    switch (event.kind) {
        case DeckEvent::Kind::plugged:
            return fmt::format("{}  connected at {}", device, event.path);
        case DeckEvent::Kind::lost:
            return fmt::format("{}  disconnected from {}", device, event.path);
        case DeckEvent::Kind::unread:
            return fmt::format("{}  unreadable report: {}", device, bytes);
        case DeckEvent::Kind::report:
            return fmt::format("{}  report: {}", device, bytes);
        case DeckEvent::Kind::control:
            break;
    }
    if (event.event.kind == JogKind::button)
        return fmt::format("{}  {} {}", device, event.event.control,
                           event.event.value != 0 ? "pressed" : "released");
    return fmt::format("{}  {} {:+.3g}", device, event.event.control, event.event.value);
}

nlohmann::ordered_json for_machines(const DeckEvent& event) {
    nlohmann::ordered_json json{
        {"time_ns", to_ns(event.time)}, {"device", event.profile->name}, {"path", event.path}};
    switch (event.kind) {
        case DeckEvent::Kind::plugged:
            json["event"] = "plugged";
            break;
        case DeckEvent::Kind::lost:
            json["event"] = "lost";
            break;
        case DeckEvent::Kind::unread:
        case DeckEvent::Kind::report:
            json["event"] = event.kind == DeckEvent::Kind::unread ? "unread" : "report";
            json["bytes"] = event.report;
            break;
        case DeckEvent::Kind::control:
            json["event"] = name_of(event.event.kind);
            json["control"] = event.event.control;
            json["value"] = event.event.value;
    }
    return json;
}

void monitor(const JogOptions& options) {
    // It must exist before the devices' threads, so that it receives the signals.
    StopSignal stop;
    JogDevices deck(make_system_jog_bus(), load_all_wheel_profiles(options.wheels),
                    {.raw_reports = options.raw});
    log_info("move a jog wheel, connected now or later; Ctrl-C ends");
    const MonotonicTime start = MonotonicClock::now();
    const auto is_over = [&](std::uint64_t events) {
        const std::chrono::duration<double> gone = MonotonicClock::now() - start;
        return stop.requested() || (options.events > 0 && events >= options.events) ||
               (options.seconds > 0 && gone.count() >= options.seconds);
    };
    for (std::uint64_t events = 0; !is_over(events);) {
        const std::optional<DeckEvent> event = deck.next(std::chrono::milliseconds(50));
        if (!event) continue;
        ++events;
        std::cout << (options.json ? for_machines(*event).dump() : for_people(*event)) << std::endl;
    }
    if (deck.dropped() > 0)
        log_warning("dropped {} events because the output was too slow", deck.dropped());
}

/// Reads lines of standard input without blocking.
class InputLines {
  public:
    /// Waits for a whole line; nothing after the timeout or at the end of the input.
    std::optional<std::string> next(std::chrono::milliseconds timeout) {
        const auto take = [&]() -> std::optional<std::string> {
            const std::size_t end = waiting_.find('\n');
            if (end == std::string::npos) return std::nullopt;
            std::string line = waiting_.substr(0, end);
            waiting_.erase(0, end + 1);
            return line;
        };
        if (std::optional<std::string> line = take()) return line;
        pollfd input{STDIN_FILENO, POLLIN, 0};
        if (ended_ || ::poll(&input, 1, static_cast<int>(timeout.count())) <= 0)
            return std::nullopt;
        std::array<char, 4096> bytes{};
        const ssize_t size = ::read(STDIN_FILENO, bytes.data(), bytes.size());
        if (size > 0)
            waiting_.append(bytes.data(), static_cast<std::size_t>(size));
        else
            ended_ = true;
        return take();
    }
    bool ended() const { return ended_; }

  private:
    std::string waiting_;
    bool ended_ = false;
};

/// Parses a line `wait SECONDS`; nothing for any other line.
std::optional<std::chrono::milliseconds> pause_of(const std::string& line) {
    std::istringstream words(line);
    std::string word;
    double seconds = 0;
    if (!(words >> word) || word != "wait") return std::nullopt;
    constexpr double max_s = 3600;
    if (!(words >> seconds) || !(seconds >= 0 && seconds <= max_s))
        fail("'{}' is not valid: give 'wait' 0 to {} seconds", line, max_s);
    return std::chrono::milliseconds(std::llround(seconds * 1000));
}

/// Prints the reports that a line caused as JSON.
void print_simulated(const std::string& line, const std::vector<SimulatedXpress::Report>& reports) {
    std::cout
        << nlohmann::ordered_json{{"event", "moved"}, {"words", line}, {"reports", reports}}.dump()
        << std::endl;
}

void simulate(const JogOptions& options) {
    StopSignal stop;
    const UhidWheel device({.vendor = SimulatedXpress::vendor,
                            .product = SimulatedXpress::product,
                            .name = SimulatedXpress::name,
                            .descriptor = UhidWheel::five_bytes(),
                            .get_feature = {},
                            .set_feature = {}});
    log_info(
        "connected a simulated {}; move it with lines of these words: {}, wait SECONDS; Ctrl-D "
        "disconnects it",
        SimulatedXpress::name, SimulatedXpress::words);
    if (options.json)
        std::cout
            << nlohmann::ordered_json{{"event", "plugged"}, {"name", SimulatedXpress::name}}.dump()
            << std::endl;
    SimulatedXpress wheel;
    InputLines lines;
    while (!stop.requested() && !lines.ended()) {
        const std::optional<std::string> line = lines.next(std::chrono::milliseconds(50));
        if (!line) continue;
        try {
            if (const auto pause = pause_of(*line)) {
                stop.wait_for(*pause);
                continue;
            }
            const std::vector<SimulatedXpress::Report> reports = wheel.reports_of(*line);
            for (const SimulatedXpress::Report& report : reports)
                device.send({report.begin(), report.end()});
            if (options.json) print_simulated(*line, reports);
        } catch (const Error& error) {
            log_error("{}", error.what());
        }
    }
}

}  // namespace

CommandEntry jog_command_entry() {
    return {[](CLI::App& program) {
        auto options = std::make_shared<JogOptions>();
        CLI::App* jog =
            program.add_subcommand("jog", "List, watch and simulate jog wheels and controllers");
        jog->require_subcommand(1);
        const auto add_common = [&](CLI::App* command) {
            command->add_option(
                "--wheels", options->wheels,
                fmt::format("Load descriptions of more wheels from {}", wheel_files_help));
            command->add_flag("--json", options->json, "Print JSON");
        };
        CLI::App* list_command = jog->add_subcommand(
            "list", "List the connected controllers, and why one cannot be used");
        add_common(list_command);
        list_command->add_flag("--all", options->all,
                               "List every HID and input device, known or not");
        list_command->callback([options] { list(*options); });
        CLI::App* monitor_command =
            jog->add_subcommand("monitor", "Print the operator's input, a line per event");
        add_common(monitor_command);
        monitor_command->add_flag("--raw", options->raw, "Print every report too, byte by byte");
        monitor_command->add_option("--seconds", options->seconds, "End after this many seconds")
            ->check(CLI::PositiveNumber);
        monitor_command->add_option("--events", options->events, "End after this many events")
            ->check(CLI::PositiveNumber);
        monitor_command->callback([options] { monitor(*options); });
        CLI::App* simulate_command = jog->add_subcommand(
            "simulate",
            "Simulate a ShuttleXpress that words on standard input move; needs root and the "
            "kernel's /dev/uhid");
        simulate_command->add_flag("--json", options->json,
                                   "Print the device and each move with its reports as lines of "
                                   "JSON");
        simulate_command->callback([options] { simulate(*options); });
    }};
}

}  // namespace vantage
