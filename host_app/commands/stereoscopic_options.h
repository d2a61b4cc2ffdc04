#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "host_app/synthesis/stereoscopy.h"

namespace vantage {

/// The options of a stereoscopic picture, which `vantage live` and `vantage render` share.
struct StereoscopicOptions {
    std::string layout = "off";
    Stereoscopy eyes;

    /// Returns the option that chooses the layout.
    CLI::Option* add_to(CLI::App& command, const std::string& default_convergence) {
        CLI::Option* chosen =
            command
                .add_option("--stereoscopic", layout,
                            "A picture for 3D displays: off, or side-by-side (left eye in the left "
                            "half, each eye at half the width)")
                ->check(CLI::IsMember({"off", "side-by-side"}));
        command
            .add_option("--interaxial-m", eyes.interaxial_m,
                        "With --stereoscopic: distance between the eyes (default: 2 % of the "
                        "picture's width of parallax in the far distance)")
            ->check(CLI::Range(0.0001, 10.0))
            ->needs(chosen);
        command
            .add_option("--convergence-m", eyes.convergence_m,
                        "With --stereoscopic: distance of what appears at the screen (default: " +
                            default_convergence + ")")
            ->check(CLI::Range(0.01, 10000.0))
            ->needs(chosen);
        return chosen;
    }

    std::optional<Stereoscopy> stereoscopy() const {
        return layout == "off" ? std::nullopt : std::optional(eyes);
    }
};

}  // namespace vantage
