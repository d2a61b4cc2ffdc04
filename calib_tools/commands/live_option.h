#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "calib_tools/commands/rig_folders.h"
#include "calib_tools/live/board_film.h"
#include "calib_tools/live/live_rigs.h"

namespace vantage {

/// --live and what belongs to it, of the commands that take pictures from running rigs too.
struct LiveOption {
    std::string stage_file;
    int views = 40;
    int patience_s = 30;
    bool go_on = false;

    void add_to(CLI::App& command);
    /// With --go-on too, for commands that film a board.
    void add_film_to(CLI::App& command);
    bool given() const { return !stage_file.empty(); }
    FilmOptions film() const { return {static_cast<std::size_t>(views), go_on}; }
    /// Throws Error as LiveRigs does.
    LiveRigs connect(const std::vector<RigFolder>& rigs, double pictures_per_second = 2) const;
};

/// The same for commands that film one rig only, whose --rig goes with --live.
struct LiveRigOption : LiveOption {
    std::string rig;

    void add_to(CLI::App& command);
    /// Throws Error if no rig was named, and as parse_rig_folders does.
    RigFolder folder() const;
    /// The pictures that a film left in the folder, left or right, as a pattern for
    /// expand_pictures.
    std::string kept_pictures(const std::string& side) const;
};

}  // namespace vantage
