#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "calib_tools/commands/rig_folders.h"
#include "calib_tools/live/board_film.h"
#include "calib_tools/live/live_rigs.h"

namespace vantage {

/// Option --live and its companions, for commands that can also take images from running rigs.
struct LiveOption {
    std::string stage_file;
    int views = 40;
    int patience_s = 30;
    bool go_on = false;

    void add_to(CLI::App& command);
    /// Also adds --go-on, for commands that film a board.
    void add_film_to(CLI::App& command);
    bool given() const { return !stage_file.empty(); }
    FilmOptions film() const { return {static_cast<std::size_t>(views), go_on}; }
    /// Throws Error like LiveRigs.
    LiveRigs connect(const std::vector<RigFolder>& rigs, double pictures_per_second = 2) const;
};

/// The same options for commands that film one rig only, with --rig for --live.
struct LiveRigOption : LiveOption {
    std::string rig;

    void add_to(CLI::App& command);
    /// Throws Error if no rig is given, and like parse_rig_folders().
    RigFolder folder() const;
    /// Pattern for expand_pictures() of the images that a film left in the folder, left or right.
    std::string kept_pictures(const std::string& side) const;
};

}  // namespace vantage
