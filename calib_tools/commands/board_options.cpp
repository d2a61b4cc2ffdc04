#include "calib_tools/commands/board_options.h"

#include "calib_tools/board/board_file.h"
#include "common/base/error.h"

namespace vantage {

void BoardOptions::add_to(CLI::App& command) {
    CLI::Option* board = command.add_option(
        "--board", size, "inner corners of the chessboard, such as 9x6; with --square-m");
    CLI::Option* square = command.add_option("--square-m", square_m,
                                             "side of a square in metres, measured on the board");
    CLI::Option* description = command.add_option(
        "--board-file", file, "description of the board that `vantage-calib board` wrote");
    board->needs(square)->excludes(description);
    square->needs(board)->excludes(description);
}

BoardPattern BoardOptions::pattern() const {
    if (!file.empty()) return load_board(file);
    if (size.empty())
        fail("which board? give --board COLUMNSxROWS and --square-m METRES, or --board-file FILE");
    return chessboard_pattern(size, square_m);
}

}  // namespace vantage
