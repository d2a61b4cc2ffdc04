#include "calib_tools/commands/lens_option.h"

namespace vantage {

void LensOption::add_to(CLI::App& command) {
    std::string names;
    for (const LensFamily& family : lens_families()) names += ", " + std::string(family.name);
    command.add_option(
        "--lens", name,
        "Set the lens model: auto (the one with the smallest error on withheld views)" + names);
}

const LensFamily* LensOption::family() const {
    return name == "auto" ? nullptr : &lens_family(name);
}

}  // namespace vantage
