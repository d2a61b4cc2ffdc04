#include "rig_firmware/trigger/gpio_line.h"

#include <algorithm>
#include <gpiod.hpp>
#include <optional>
#include <system_error>
#include <vector>

#include "common/base/cli/nearest_name.h"
#include "common/base/error.h"

namespace vantage {
namespace {

std::optional<unsigned> offset_of(const gpiod::chip& chip, const RigConfig::Trigger& trigger,
                                  std::size_t lines) {
    if (trigger.line_offset >= 0) {
        const auto offset = static_cast<unsigned>(trigger.line_offset);
        if (offset < lines) return offset;
        return std::nullopt;
    }
    const int offset = chip.get_line_offset_from_name(trigger.line);
    if (offset < 0) return std::nullopt;
    return static_cast<unsigned>(offset);
}

std::vector<std::string> line_names(const gpiod::chip& chip, std::size_t lines) {
    std::vector<std::string> names;
    for (unsigned offset = 0; offset < lines; ++offset)
        if (std::string name = chip.get_line_info(offset).name(); !name.empty())
            names.push_back(std::move(name));
    return names;
}

}  // namespace

std::vector<std::filesystem::path> gpio_chips() {
    std::vector<std::filesystem::path> paths;
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator("/dev", ignored))
        if (entry.path().filename().string().starts_with("gpiochip")) paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    return paths;
}

std::string GpioLine::text() const {
    return name.empty() ? fmt::format("line {} of '{}'", offset, label)
                        : fmt::format("line {} '{}' of '{}'", offset, name, label);
}

GpioLine find_gpio_line(const RigConfig::Trigger& trigger) {
    std::vector<std::string> labels;
    std::string forbidden;
    for (const std::filesystem::path& path : gpio_chips()) {
        try {
            const gpiod::chip chip(path);
            const gpiod::chip_info info = chip.get_info();
            labels.push_back(info.label());
            if (info.label() != trigger.chip) continue;
            const auto offset = offset_of(chip, trigger, info.num_lines());
            if (!offset && trigger.line_offset >= 0)
                fail("the GPIO chip '{}' has {} lines, and 'line_offset' in [trigger] is {}",
                     trigger.chip, info.num_lines(), trigger.line_offset);
            if (!offset)
                fail("the GPIO chip '{}' has no line '{}'; {}", trigger.chip, trigger.line,
                     suggest_name(trigger.line, line_names(chip, info.num_lines())));
            const gpiod::line_info line = chip.get_line_info(*offset);
            return {.chip = path,
                    .label = info.label(),
                    .offset = *offset,
                    .name = line.name(),
                    .consumer = line.consumer(),
                    .is_used = line.used()};
        } catch (const std::system_error& error) {
            if (error.code() == std::errc::permission_denied) forbidden = path.string();
        }
    }
    if (!forbidden.empty())
        fail(
            "the GPIO chip '{}' is not among those that this user may open, and {} may not be "
            "opened: put the user into the group 'gpio', or install the udev rules of Vantage "
            "(60-vantage-gpio.rules)",
            trigger.chip, forbidden);
    if (labels.empty())
        fail(
            "there is no GPIO chip, and '{}' is named: load its driver, or set role = \"free\" in "
            "[trigger]",
            trigger.chip);
    fail("there is no GPIO chip '{}'; {}", trigger.chip, suggest_name(trigger.chip, labels));
}

}  // namespace vantage
