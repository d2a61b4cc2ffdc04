#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "host_app/desk/desk_switches.h"

namespace vantage {

/// Where a window stands among the monitors, in the screen's coordinates.
struct WindowPlace {
    int x = 0, y = 0, width = 1280, height = 720;
    bool is_maximised = false;  ///< and the rest is where it goes back to
    bool operator==(const WindowPlace&) const = default;
};

/// How hands have arranged the desk.
struct DeskArrangement {
    DeskSwitches switches;  ///< but for the help
    std::optional<WindowPlace> window = {};
    std::optional<WindowPlace> rigs_window = {};  ///< their own
    bool operator==(const DeskArrangement&) const = default;
};

/// Reads a desk file (docs/desk_file.md shows every key). Throws Error with file and line for
/// whatever does not fit.
DeskArrangement load_desk(const std::filesystem::path& path);
/// As a desk file: what load_desk() reads again, angles to a tenth of a degree.
std::string to_toml(const DeskArrangement& desk);

}  // namespace vantage
