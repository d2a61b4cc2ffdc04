#include "common/board/board_file.h"

#include <span>
#include <string>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/board/charuco_finder.h"
#include "common/config/toml_reader.h"

namespace vantage {
namespace {

constexpr int file_version = 1, most_markers = 9999;

}  // namespace

std::vector<BoardPattern> load_body(const std::filesystem::path& path) {
    BoardPattern pattern;
    std::vector<int> first_markers;
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
            top.read("legacy", pattern.legacy);
            top.read("first_marker", pattern.first_marker, {0, most_markers});
            top.read("first_markers", first_markers, {0, most_markers});
            if (top.has("first_markers") && top.has("first_marker"))
                top.refuse("first_markers",
                           "cannot stand beside first_marker: a body has a first "
                           "marker for every face, a board only one");
            if (top.has("first_markers") && first_markers.empty())
                top.refuse("first_markers", "needs at least one face");
        }
    });
    if (first_markers.empty()) first_markers.push_back(pattern.first_marker);
    std::vector<BoardPattern> faces;
    for (const int first : first_markers) {
        pattern.first_marker = first;
        try {
            pattern.validate();
            if (pattern.kind == BoardKind::charuco) require_enough_markers(pattern);
        } catch (const Error& error) {
            fail("{}: {}", path.string(), error.what());
        }
        faces.push_back(pattern);
    }
    return faces;
}

BoardPattern load_board(const std::filesystem::path& path) {
    const std::vector<BoardPattern> faces = load_body(path);
    if (faces.size() > 1)
        fail(
            "{} describes a body of {} boards: cameras and rigs are calibrated with one flat "
            "board, only `stage` takes bodies",
            path.string(), faces.size());
    return faces.front();
}

void save_board(const std::filesystem::path& path, const BoardPattern& pattern) {
    save_body(path, {pattern});
}

void save_body(const std::filesystem::path& path, const std::vector<BoardPattern>& faces) {
    const BoardPattern& pattern = faces.front();
    std::string text = fmt::format(
        "# {}. columns and rows count inner corners, where four squares meet.\n"
        "# Measure the printed squares and correct square_m: printers scale.\n"
        "version = {}\nkind = \"{}\"\ncolumns = {}\nrows = {}\nsquare_m = {}\n",
        faces.size() > 1 ? "Boards that are fixed to each other, one a face of a cube"
                         : "A calibration target",
        file_version, pattern.kind == BoardKind::charuco ? "charuco" : "chessboard",
        pattern.columns, pattern.rows, pattern.square_m);
    if (pattern.kind == BoardKind::charuco) {
        text += fmt::format("marker_m = {}\ndictionary = \"{}\"\n", pattern.marker_m,
                            pattern.dictionary);
        if (pattern.legacy) text += "# Laid out as OpenCV did before 4.6.\nlegacy = true\n";
        std::string firsts;
        for (const BoardPattern& face : faces)
            firsts += (firsts.empty() ? "" : ", ") + std::to_string(face.first_marker);
        text += faces.size() > 1
                    ? fmt::format(
                          "# The first marker of every face; a wand has those of all its "
                          "cubes. How faces stand to each other is found by `stage`.\n"
                          "first_markers = [{}]\n",
                          firsts)
                    : fmt::format("first_marker = {}\n", firsts);
    }
    write_file_atomically(path, std::as_bytes(std::span(text)));
}

}  // namespace vantage
