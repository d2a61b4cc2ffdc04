#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "calib_tools/board/board_drawing.h"
#include "calib_tools/board/paper.h"
#include "common/base/cli/command.h"
#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/log.h"
#include "common/board/board_file.h"
#include "common/board/charuco_finder.h"
#include "common/board/chessboard_finder.h"
#include "common/image/image_file.h"

namespace vantage {
namespace {

struct PrintedBoardOptions {
    std::string kind = "charuco", size, output, dictionary = "5X5_250", paper;
    double square_m = 0, marker_m = 0, dots_per_inch = 300;
    int first_marker = 0, faces = 1;
    bool json = false;
};

/// Default size of a marker: this share of a square, rounded to a micrometre.
double usual_marker_m(double square_m) { return std::round(0.7e6 * square_m) / 1e6; }

/// Boards to draw: one, or one per face.
std::vector<BoardPattern> wanted_faces(const PrintedBoardOptions& options,
                                       const std::optional<Paper>& paper) {
    const bool is_cut_out = options.faces > 1;
    if (options.square_m == 0 && !paper)
        fail("how large? give --square-m METRES, or --paper for the largest that fits a sheet");
    double square_m = options.square_m;
    if (square_m == 0)
        square_m = largest_square_m(chessboard_pattern(options.size, 1), is_cut_out, *paper);
    BoardPattern pattern = chessboard_pattern(options.size, square_m);
    if (options.kind == "charuco") {
        pattern.kind = BoardKind::charuco;
        pattern.marker_m =
            options.marker_m > 0 ? options.marker_m : usual_marker_m(pattern.square_m);
        pattern.dictionary = options.dictionary;
        pattern.first_marker = options.first_marker;
        pattern.validate();
        require_enough_markers(pattern);
    }
    std::vector<BoardPattern> faces{pattern};
    if (is_cut_out && pattern.kind == BoardKind::chessboard)
        fail("the faces of a body are told apart by their markers: take --kind charuco");
    while (static_cast<int>(faces.size()) < options.faces) {
        pattern.first_marker += marker_count(pattern);
        require_enough_markers(pattern);
        faces.push_back(pattern);
    }
    return faces;
}

/// Throws Error if the file exists with other values, since it may hold measurements of the print.
void require_not_measured(const std::string& description, const std::vector<BoardPattern>& faces) {
    if (!std::filesystem::exists(description)) return;
    const std::vector<BoardPattern> there = load_body(description);
    if (there == faces) return;
    if (there.front().square_m != faces.front().square_m)
        fail(
            "{} says square_m = {}, perhaps as measured, and this board has {}: nothing is "
            "written; give another name with -o, or remove the file",
            description, there.front().square_m, faces.front().square_m);
    fail("{} describes another board: nothing is written; give another name with -o, or remove it",
         description);
}

/// The path that the files' extensions are added to: one of them may be given with it.
std::string without_extension(const std::string& output) {
    std::filesystem::path path = output;
    for (const char* extension : {".pdf", ".png", ".toml"})
        if (path.extension() == extension) return path.replace_extension().string();
    return output;
}

void run(const PrintedBoardOptions& options) {
    std::optional<Paper> paper;
    if (!options.paper.empty()) paper = paper_named(options.paper);
    const std::vector<BoardPattern> faces = wanted_faces(options, paper);
    const BoardPattern& pattern = faces.front();
    if (pattern.kind == BoardKind::chessboard && looks_alike_half_turned(pattern))
        log_warning(
            "a chessboard of {} inner corners looks the same when it is turned half round: `stage` "
            "refuses it, and `stereo` cannot tell a picture that was turned. Take one with an even "
            "and an odd side, such as {}x{}, or --kind charuco",
            pattern.size_name(), pattern.columns + 1, pattern.rows);
    const int square_px =
        static_cast<int>(std::lround(pattern.square_m / 0.0254 * options.dots_per_inch));
    const double widest = (std::max(pattern.columns, pattern.rows) + 3) * square_px;
    if (square_px < 12 || widest > max_image_side_px)
        fail(
            "at {} dots per inch a square is {} px and the picture {} px wide; 12 px and {} px are "
            "the limits: change --dpi",
            options.dots_per_inch, square_px, widest, max_image_side_px);
    const std::string output = without_extension(options.output);
    const std::string pdf = output + ".pdf", description = output + ".toml";
    require_not_measured(description, faces);
    const std::vector<std::byte> pages = board_as_pdf(faces, paper);
    const std::string page = page_in_words(page_of(pattern, faces.size() > 1), paper);
    std::vector<std::string> pngs;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        pngs.push_back(output + (faces.size() > 1 ? fmt::format("_{}.png", i + 1) : ".png"));
        write_grey_image(pngs.back(), draw_board(faces[i], square_px));
    }
    write_file_atomically(pdf, pages);
    if (!std::filesystem::exists(description)) save_body(description, faces);
    if (options.json) {
        nlohmann::json json = {{"png", pngs.front()},
                               {"pdf", pdf},
                               {"description", description},
                               {"columns", pattern.columns},
                               {"rows", pattern.rows},
                               {"square_m", pattern.square_m},
                               {"page", page}};
        if (faces.size() > 1) json["pngs"] = pngs;
        std::cout << json.dump(2) << '\n';
    } else if (faces.size() > 1) {
        std::cout << fmt::format(
            "{} (a page a face, each {}), {} to {} and {} written; print at 100 %, cut along the "
            "frames, "
            "glue one to each face of a stiff body, measure a row of squares and correct square_m "
            "in {}\n",
            pdf, page, pngs.front(), pngs.back(), description, description);
    } else {
        std::cout << fmt::format(
            "{} ({}), {} and {} written; print at 100 %, glue it to something flat, measure a row "
            "of "
            "squares and correct square_m in {}\n",
            pdf, page, pngs.front(), description, description);
    }
}

}  // namespace

CommandEntry board_command_entry() {
    return {[](CLI::App& program) {
        CLI::App* command =
            program.add_subcommand("board",
                                   "Draw a calibration board: a PDF true to scale, a PNG, and a "
                                   "description for the other commands");
        const auto options = std::make_shared<PrintedBoardOptions>();
        command->add_option("--kind", options->kind, "Draw this kind of board")
            ->check(CLI::IsMember({"chessboard", "charuco"}))
            ->capture_default_str();
        command
            ->add_option("--board", options->size,
                         "Set the number of inner corners, COLUMNSxROWS, such as 9x6")
            ->required();
        command
            ->add_option(
                "--square-m", options->square_m,
                "Set the side of a square in metres (default with --paper: the largest that fits)")
            ->check(CLI::PositiveNumber);
        command->add_option("--paper", options->paper,
                            "Draw on this sheet: a4, a3, a2, letter, or WIDTHxHEIGHT in mm; a "
                            "board that does not fit is refused");
        command->add_option("--marker-m", options->marker_m,
                            "Set the side of a marker in metres (default: 0.7 of the square's)");
        command
            ->add_option("--dictionary", options->dictionary,
                         "Take the markers from this ArUco dictionary")
            ->capture_default_str();
        command
            ->add_option("--first-marker", options->first_marker,
                         "Set the number of the first marker; boards that are used together need "
                         "different markers")
            ->check(CLI::Range(0, 9999))
            ->capture_default_str();
        command
            ->add_option("--faces", options->faces,
                         "Draw this many boards for the faces of a cube, or of several cubes on a "
                         "stick; each board gets different markers")
            ->check(CLI::Range(1, 100))
            ->capture_default_str();
        command
            ->add_option("--dpi", options->dots_per_inch,
                         "Set the resolution of the PNG in dots per inch")
            ->check(CLI::Range(10.0, 2400.0))
            ->capture_default_str();
        command
            ->add_option("-o,--output", options->output, "Write PATH.pdf, PATH.png and PATH.toml")
            ->required();
        command->add_flag("--json", options->json, "Print the result as JSON");
        command->callback([options] { run(*options); });
    }};
}

}  // namespace vantage
