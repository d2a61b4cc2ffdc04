#include <iostream>
#include <iterator>
#include <memory>
#include <tuple>

#include <CLI/CLI.hpp>

#include "calib_tools/commands/board_options.h"
#include "calib_tools/commands/lens_option.h"
#include "calib_tools/commands/live_option.h"
#include "calib_tools/live/board_film.h"
#include "calib_tools/pictures/film_frames.h"
#include "calib_tools/report/calibration_json.h"
#include "calib_tools/report/calibration_page.h"
#include "calib_tools/report/calibration_text.h"
#include "calib_tools/rig/rig_calibration.h"
#include "common/base/cli/command.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/config/calibration_file.h"
#include "common/image/picture_list.h"

namespace vantage {
namespace {

struct StereoOptions {
    BoardOptions board;
    LensOption lens;
    LiveRigOption live;
    std::vector<std::string> left, right, side_by_side;
    std::string output;
    double alpha = 0, far_m = 0;
    std::vector<int> rectified_size;
    std::string html;
    bool json = false;
};

struct SeenPairs {
    std::vector<SeenPicture> left, right;
    std::vector<std::filesystem::path> alone;
    std::string kept;  ///< see BoardFilm::kept
};

/// Detects the board in both series, whose pictures at one place are a pair.
SeenPairs look_at_pairs(std::vector<SeenPicture> left, std::vector<SeenPicture> right,
                        const BoardPattern& pattern) {
    const std::size_t pairs = left.size();
    std::move(right.begin(), right.end(), std::back_inserter(left));
    std::vector<SeenPicture> seen = look_at_pictures(std::move(left), pattern);
    const auto middle = std::make_move_iterator(seen.begin() + static_cast<std::ptrdiff_t>(pairs));
    return {{std::make_move_iterator(seen.begin()), middle},
            {middle, std::make_move_iterator(seen.end())},
            {},
            {}};
}

SeenPairs pairs_side_by_side(const std::vector<std::string>& names, const BoardPattern& pattern) {
    const std::filesystem::path film = film_among(names);
    PictureHalves halves = halves_of(film.empty() ? read_pictures(expand_pictures(names))
                                                  : read_film_frames({film}).front());
    return look_at_pairs(std::move(halves.left), std::move(halves.right), pattern);
}

SeenPairs pairs_from_files(const StereoOptions& options, const BoardPattern& pattern) {
    if (!options.side_by_side.empty()) return pairs_side_by_side(options.side_by_side, pattern);
    std::vector<std::string> lefts = options.left, rights = options.right;
    if (lefts.empty() && rights.empty() && !options.live.rig.empty()) {
        lefts = {options.live.kept_pictures("left")};
        rights = {options.live.kept_pictures("right")};
    }
    if (lefts.empty() || rights.empty())
        fail(
            "which pictures? give --left and --right, --side-by-side for pictures that hold both "
            "sides, --rig NAME=FOLDER, or --live and --rig");
    const std::filesystem::path left_film = film_among(lefts), right_film = film_among(rights);
    if (left_film.empty() != right_film.empty())
        fail(
            "one side is a video and the other is not: give two videos, or pictures of both sides");
    if (!left_film.empty()) {
        std::vector<std::vector<SeenPicture>> frames = read_film_frames({left_film, right_film});
        return look_at_pairs(std::move(frames[0]), std::move(frames[1]), pattern);
    }
    const PicturePairs pictures = pair_pictures(expand_pictures(lefts), expand_pictures(rights));
    std::vector<SeenPicture> left(pictures.pairs.size()), right(pictures.pairs.size());
    for (std::size_t i = 0; i < pictures.pairs.size(); ++i)
        std::tie(left[i].path, right[i].path) = pictures.pairs[i];
    SeenPairs result = look_at_pairs(std::move(left), std::move(right), pattern);
    result.alone = pictures.alone;
    return result;
}

SeenPairs pairs_from_rig(const StereoOptions& options, const BoardPattern& pattern) {
    const RigFolder rig = options.live.folder();
    LiveRigs rigs = options.live.connect({rig});
    BoardFilm film =
        film_board(rigs, {{0, true, "left", rig.folder}, {0, false, "right", rig.folder}}, pattern,
                   options.live.film(), all_see_board, lens_advice({"left", "right"}));
    return {std::move(film.pictures[0]), std::move(film.pictures[1]), {}, film.kept};
}

void run(const StereoOptions& options) {
    const BoardPattern pattern = options.board.pattern("--left and --right");
    RigOptions rig_options;
    rig_options.family = options.lens.family();
    rig_options.alpha = options.alpha;
    if (options.far_m > 0) rig_options.far_m = options.far_m;
    if (!options.rectified_size.empty()) {
        rig_options.rectified_width_px = options.rectified_size[0];
        rig_options.rectified_height_px = options.rectified_size[1];
    }
    SeenPairs seen = options.live.given() ? pairs_from_rig(options, pattern)
                                          : pairs_from_files(options, pattern);
    RigCalibration result = with_kept_film(seen.kept, [&] {
        return calibrate_rig(std::move(seen.left), std::move(seen.right), pattern, rig_options);
    });
    for (const std::filesystem::path& file : seen.alone) {
        ++result.views_given;
        result.rejected.push_back(
            {file.filename().string(), "has no partner of the same number on the other side"});
    }
    assume_place(result.calibration);
    save_calibration(options.output, result.calibration,
                     {.date = date_now(),
                      .tool = "vantage-calib stereo",
                      .rms_px = result.bundle.rms_px(),
                      .row_rms_px = result.row_rms_px,
                      .views_used = static_cast<int>(result.views_used),
                      .alpha = options.alpha,
                      .sigma = calibration_sigma(result)});
    log_info("{} written", options.output);
    if (!options.html.empty()) {
        calibration_page(result).save(options.html);
        log_info("{} written", options.html);
    }
    if (options.json)
        std::cout << to_json(result).dump(2) << '\n';
    else
        std::cout << describe(result);
}

}  // namespace

CommandEntry stereo_command_entry() {
    return {[](CLI::App& program) {
        CLI::App* command = program.add_subcommand(
            "stereo", "Calibrate a stereo rig from pairs of pictures of a board");
        const auto options = std::make_shared<StereoOptions>();
        options->board.add_to(*command);
        options->lens.add_to(*command);
        command->add_option("--left", options->left,
                            "Read the left pictures: 'PATTERN', a folder, files or a video");
        command->add_option("--right", options->right,
                            "Read the right pictures: 'PATTERN', a folder, files or a video");
        command
            ->add_option(
                "--side-by-side", options->side_by_side,
                "Read pictures or a video that hold both sides, the left one in the left half")
            ->excludes("--left", "--right");
        options->live.add_to(*command);
        command->add_option("-o,--output", options->output, "Write this calibration file (YAML)")
            ->required();
        command
            ->add_option(
                "--alpha", options->alpha,
                "Crop the rectified picture: 0 keeps valid pixels only, 1 keeps all raw pixels")
            ->check(CLI::Range(0.0, 1.0))
            ->capture_default_str();
        command
            ->add_option("--far-m", options->far_m,
                         "Set the distance in metres at which the disparity is 0; nothing beyond "
                         "it is measured (default: infinity; for cameras that are toed in, twice "
                         "the distance at which their axes cross)")
            ->check(CLI::PositiveNumber);
        command
            ->add_option("--rectified-size", options->rectified_size,
                         "Set WIDTH and HEIGHT of the rectified pictures (default: those of the "
                         "raw pictures)")
            ->expected(2)
            ->check(CLI::Range(16, 16384));
        command->add_option("--html", options->html, "Write a report for a browser to this file");
        command->add_flag("--json", options->json, "Print the result as JSON");
        command->callback([options] { run(*options); });
    }};
}

}  // namespace vantage
