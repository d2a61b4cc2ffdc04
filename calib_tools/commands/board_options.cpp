#include "calib_tools/commands/board_options.h"

#include <filesystem>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/base/error.h"
#include "common/board/board_file.h"

namespace vantage {

void BoardOptions::add_to(CLI::App& command) {
    CLI::Option* board = command.add_option(
        "--board", size, "Set the number of inner corners of the chessboard, such as 9x6");
    CLI::Option* square = command.add_option(
        "--square-m", square_m, "Set the side of a square in metres, measured on the board");
    CLI::Option* description = command.add_option(
        "--board-file", files, "description of the board that `vantage-calib board` wrote");
    board->needs(square)->excludes(description);
    board->check([](const std::string& text) {
        return text.ends_with(".toml")
                   ? fmt::format("{} describes a board: give it as --board-file {}", text, text)
                   : std::string();
    });
    square->needs(board)->excludes(description);
}

BoardPattern BoardOptions::pattern(const char* for_pictures) const {
    for (std::size_t i = 1; i < files.size(); ++i)
        if (!files[i].ends_with(".toml"))
            fail("{} is no description of a board (.toml): pictures go behind {}", files[i],
                 for_pictures);
    if (files.size() > 1)
        fail(
            "{} boards are described, and a camera or rig is calibrated with one: only `stage` "
            "takes several",
            files.size());
    return files.empty() ? chessboard() : load_board(files.front());
}

BoardPattern BoardOptions::chessboard() const {
    if (size.empty())
        fail("which board? give --board COLUMNSxROWS and --square-m METRES, or --board-file FILE");
    return chessboard_pattern(size, square_m);
}

CalibrationBoards BoardOptions::boards() const {
    if (files.empty()) return chessboard();
    CalibrationBoards set;
    for (const std::string& file : files)
        set.add(std::filesystem::path(file).stem().string(), load_body(file));
    set.validate();
    return set;
}

}  // namespace vantage
