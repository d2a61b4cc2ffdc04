#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/board/calibration_boards.h"

namespace vantage {

/// Options --board and --square-m, or --board-file, of commands that look for a board.
struct BoardOptions {
    std::string size;
    std::vector<std::string> files;
    double square_m = 0;

    void add_to(CLI::App& command);
    /// Throws Error if the options do not give one board. `for_pictures` names the options for
    /// images, for the error message.
    BoardPattern pattern(const char* for_pictures) const;
    /// All boards, single and in bodies, each named by its file. Throws Error if they cannot be
    /// distinguished.
    CalibrationBoards boards() const;

  private:
    BoardPattern chessboard() const;
};

}  // namespace vantage
