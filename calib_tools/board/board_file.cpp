#include "calib_tools/board/board_file.h"

#include <span>
#include <string>

#include "calib_tools/board/charuco_finder.h"
#include "common/base/atomic_file.h"
#include "common/base/error.h"
#include "common/config/toml_reader.h"

namespace vantage {
namespace {

constexpr int file_version = 1;

}  // namespace

BoardPattern load_board(const std::filesystem::path& path) {
    BoardPattern pattern;
    read_toml_file(path, file_version, [&](TomlTable& top) {
        std::string kind = "chessboard";
        top.read_choice("kind", kind, {"chessboard", "charuco"});
        top.read("columns", pattern.columns, {3, 100});
        top.read("rows", pattern.rows, {3, 100});
        top.read("square_m", pattern.square_m, {1e-4, 10});
        for (const char* key : {"kind", "columns", "rows", "square_m"}) top.require(key);
        if (kind == "charuco") {
            pattern.kind = BoardKind::charuco;
            top.read("marker_m", pattern.marker_m, {1e-5, 10});
            top.read("dictionary", pattern.dictionary);
            for (const char* key : {"marker_m", "dictionary"}) top.require(key);
        }
    });
    pattern.validate();
    if (pattern.kind == BoardKind::charuco) require_enough_markers(pattern);
    return pattern;
}

void save_board(const std::filesystem::path& path, const BoardPattern& pattern) {
    std::string text = fmt::format(
        "# A calibration target. columns and rows count inner corners, where four squares meet.\n"
        "# Measure the printed squares and correct square_m: printers scale.\n"
        "version = {}\nkind = \"{}\"\ncolumns = {}\nrows = {}\nsquare_m = {}\n",
        file_version, pattern.kind == BoardKind::charuco ? "charuco" : "chessboard",
        pattern.columns, pattern.rows, pattern.square_m);
    if (pattern.kind == BoardKind::charuco)
        text += fmt::format("marker_m = {}\ndictionary = \"{}\"\n", pattern.marker_m,
                            pattern.dictionary);
    write_file_atomically(path, std::as_bytes(std::span(text)));
}

}  // namespace vantage
