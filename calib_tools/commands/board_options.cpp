#include "calib_tools/commands/board_options.h"

namespace vantage {

void BoardOptions::add_to(CLI::App& command) {
    command.add_option("--board", size, "inner corners of the chessboard, such as 9x6")->required();
    command.add_option("--square-m", square_m, "side of a square in metres, measured on the board")
        ->required();
}

BoardPattern BoardOptions::pattern() const { return chessboard_pattern(size, square_m); }

}  // namespace vantage
