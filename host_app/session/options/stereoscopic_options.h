#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "host_app/synthesis/stereoscopy.h"

namespace vantage {

/// The options of a stereoscopic picture, which `vantage live` and `vantage render` share.
struct StereoscopicOptions {
    std::string layout = "off", quilt;
    Stereoscopy eyes;

    /// Returns the option that chooses the layout.
    CLI::Option* add_to(CLI::App& command, const std::string& default_convergence) {
        std::vector<std::string> layouts{"off"};
        for (const std::string& name : stereo_layout_names()) layouts.push_back(name);
        CLI::Option* chosen =
            command
                .add_option("--stereoscopic", layout,
                            "A picture for 3D displays: both eyes at half the width, the height or "
                            "every other row, for red and cyan glasses, or many views (--quilt)")
                ->check(CLI::IsMember(layouts));
        command
            .add_option("--interaxial-m", eyes.interaxial_m,
                        "With --stereoscopic: distance between the outermost eyes (default: 2 % of "
                        "the picture's width of parallax in the far distance, in a quilt 8 %)")
            ->check(CLI::Range(0.0001, 10.0))
            ->needs(chosen);
        command
            .add_option("--convergence-m", eyes.convergence_m,
                        "With --stereoscopic: distance of what appears at the screen (default: " +
                            default_convergence + ")")
            ->check(CLI::Range(0.01, 10000.0))
            ->needs(chosen);
        command
            .add_option("--quilt", quilt,
                        "With --stereoscopic quilt: COLUMNSxROWS of views for an autostereoscopic "
                        "display, the leftmost at the lower left (default: 8x6)")
            ->needs(chosen);
        return chosen;
    }

    /// Throws Error if --quilt says no quilt, or there is none.
    std::optional<Stereoscopy> stereoscopy() const;
};

}  // namespace vantage
