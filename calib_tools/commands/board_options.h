#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "calib_tools/board/board_pattern.h"

namespace vantage {

/// --board and --square-m, or --board-file, of the commands that look for a board.
struct BoardOptions {
    std::string size, file;
    double square_m = 0;

    void add_to(CLI::App& command);
    /// Throws Error if the options do not make a board.
    BoardPattern pattern() const;
};

}  // namespace vantage
