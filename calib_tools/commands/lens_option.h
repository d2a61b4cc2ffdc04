#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "calib_tools/bundle/lens_family.h"

namespace vantage {

/// --lens of the commands that calibrate lenses.
struct LensOption {
    std::string name = "auto";

    void add_to(CLI::App& command);
    /// Null for `auto`. Throws Error for a name that there is not.
    const LensFamily* family() const;
};

}  // namespace vantage
