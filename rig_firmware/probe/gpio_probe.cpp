#include <filesystem>
#include <gpiod.hpp>
#include <system_error>

#include <fmt/format.h>

#include "rig_firmware/probe/probe.h"
#include "rig_firmware/trigger/gpio_line.h"

namespace vantage {
namespace {

void add_chip(ProbePart& part, const std::filesystem::path& path) {
    gpiod::chip chip(path);
    const gpiod::chip_info info = chip.get_info();
    nlohmann::json lines = nlohmann::json::array();
    part.lines.push_back(
        fmt::format("{} '{}', {} lines", path.string(), info.label(), info.num_lines()));
    for (unsigned offset = 0; offset < info.num_lines(); ++offset) {
        const gpiod::line_info line = chip.get_line_info(gpiod::line::offset(offset));
        const bool is_output = line.direction() == gpiod::line::direction::OUTPUT;
        lines.push_back({{"offset", offset},
                         {"name", line.name()},
                         {"direction", is_output ? "output" : "input"},
                         {"is_used", line.used()},
                         {"consumer", line.consumer()}});
        part.lines.push_back(
            fmt::format("    {:3} {:<16} {:<6} {}", offset, line.name().empty() ? "-" : line.name(),
                        is_output ? "output" : "input",
                        !line.used()              ? std::string("free")
                        : line.consumer().empty() ? std::string("held, by the kernel")
                                                  : fmt::format("held by '{}'", line.consumer())));
    }
    part.facts.push_back({{"path", path.string()},
                          {"name", info.name()},
                          {"label", info.label()},
                          {"lines", std::move(lines)}});
}

}  // namespace

ProbePart probe_gpio() {
    ProbePart part{
        .title = "GPIO chips", .facts = nlohmann::json::array(), .lines = {}, .unfit = {}};
    const std::vector<std::filesystem::path> chips = gpio_chips();
    for (const std::filesystem::path& path : chips) {
        try {
            add_chip(part, path);
        } catch (const std::system_error& error) {
            const bool forbidden = error.code() == std::errc::permission_denied;
            part.unfit.push_back(
                forbidden
                    ? fmt::format("{} may not be opened by this user: put the user into the "
                                  "group 'gpio', or install the udev rules of Vantage "
                                  "(60-vantage-gpio.rules)",
                                  path.string())
                    : fmt::format("{} cannot be read: {}", path.string(), error.code().message()));
        }
    }
    if (chips.empty())
        part.unfit.emplace_back(
            "there is no GPIO chip: this computer can neither give trigger pulses nor see them, "
            "and "
            "its cameras must run by themselves or be triggered by another rig's wire");
    return part;
}

}  // namespace vantage
