#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "tests/support/child_program.h"

namespace vantage {

/// Writes NAME.toml into a folder and starts a rig with it: 96x72 pixels of the virtual stage, 5
/// Hz, exact depth. `program` is the path of vantage-rig.
inline std::unique_ptr<ChildProgram> start_tiny_rig(const std::string& program,
                                                    const std::filesystem::path& folder,
                                                    const std::string& name, int azimuth_deg,
                                                    const std::string& endpoint) {
    const std::string file = (folder / (name + ".toml")).string();
    std::ofstream(file) << "version = 1\nname = \"" << name
                        << "\"\n[source]\nrate_hz = 5\nwidth_px = 96\nheight_px = 72\n"
                        << "[virtual_rig]\nazimuth_deg = " << azimuth_deg
                        << "\n[match]\nmatcher = \"exact\"\ndisparities = 32\n[stream]\nbind = \""
                        << endpoint << "\"\n";
    return std::make_unique<ChildProgram>(
        program, std::vector<std::string>{"run", "--config", file}, folder);
}

}  // namespace vantage
