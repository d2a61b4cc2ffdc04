#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "calib_tools/bundle/lens_family.h"

namespace vantage {

/// Option --lens of commands that calibrate lenses.
struct LensOption {
    std::string name = "auto";

    void add_to(CLI::App& command);
    /// Null for `auto`. Throws Error for an unknown name.
    const LensFamily* family() const;
};

}  // namespace vantage
