#include <iostream>
#include <memory>

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

/// Frames of a video that are searched for the board, at most.
constexpr std::size_t most_film_frames = 60;

struct StereoOptions {
    BoardOptions board;
    LensOption lens;
    LiveRigOption live;
    std::vector<std::string> left, right;
    std::string output;
    double alpha = 0, far_m = 0;
    std::vector<int> rectified_size;
    std::string html;
    bool json = false;
};

struct SeenPairs {
    std::vector<SeenPicture> left, right;
    std::vector<std::filesystem::path> alone;
    std::string kept;                        ///< see BoardFilm::kept
    std::shared_ptr<FilmFrames> films = {};  ///< keeps the frames of videos
};

SeenPairs pairs_from_files(const StereoOptions& options, const BoardPattern& pattern) {
    std::vector<std::string> lefts = options.left, rights = options.right;
    if (lefts.empty() && rights.empty() && !options.live.rig.empty()) {
        lefts = {options.live.kept_pictures("left")};
        rights = {options.live.kept_pictures("right")};
    }
    if (lefts.empty() || rights.empty())
        fail("which pictures? give --left and --right, --rig NAME=FOLDER, or --live and --rig");
    const std::filesystem::path left_film = film_among(lefts), right_film = film_among(rights);
    if (left_film.empty() != right_film.empty())
        fail(
            "one side is a video and the other is not: give two videos, or pictures of both sides");
    PicturePairs pictures;
    SeenPairs result;
    if (!left_film.empty()) {
        result.films = std::make_shared<FilmFrames>(
            std::vector<std::filesystem::path>{left_film, right_film}, most_film_frames);
        pictures = pair_pictures(result.films->pictures()[0], result.films->pictures()[1]);
    } else {
        pictures = pair_pictures(expand_pictures(lefts), expand_pictures(rights));
    }
    std::vector<std::filesystem::path> files;
    for (const auto& [left, right] : pictures.pairs) files.push_back(left);
    for (const auto& [left, right] : pictures.pairs) files.push_back(right);
    const std::vector<SeenPicture> seen = look_at_pictures(files, pattern);
    const auto middle = seen.begin() + static_cast<std::ptrdiff_t>(pictures.pairs.size());
    result.left.assign(seen.begin(), middle);
    result.right.assign(middle, seen.end());
    result.alone = pictures.alone;
    return result;
}

SeenPairs pairs_from_rig(const StereoOptions& options, const BoardPattern& pattern) {
    const RigFolder rig = options.live.folder();
    LiveRigs rigs = options.live.connect({rig});
    BoardFilm film =
        film_board(rigs, {{0, true, "left", rig.folder}, {0, false, "right", rig.folder}}, pattern,
                   options.live.film(), all_see_board, lens_advice({"left", "right"}));
    return {std::move(film.pictures[0]), std::move(film.pictures[1]), {}, film.kept, {}};
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
                            "left pictures: 'PATTERN', folder, files or a video");
        command->add_option("--right", options->right,
                            "right pictures: 'PATTERN', folder, files or a video");
        options->live.add_to(*command);
        command->add_option("-o,--output", options->output, "calibration file to write (YAML)")
            ->required();
        command
            ->add_option("--alpha", options->alpha,
                         "rectified picture: 0 only valid pixels, 1 all raw pixels")
            ->check(CLI::Range(0.0, 1.0))
            ->capture_default_str();
        command
            ->add_option("--far-m", options->far_m,
                         "distance in metres at which the disparity is 0, nothing beyond is "
                         "measured (default: infinity, or twice the distance at which the axes of "
                         "cameras that are toed in cross)")
            ->check(CLI::PositiveNumber);
        command
            ->add_option("--rectified-size", options->rectified_size,
                         "WIDTH HEIGHT of the rectified pictures (default: as the raw ones)")
            ->expected(2)
            ->check(CLI::Range(16, 16384));
        command->add_option("--html", options->html, "report to write, a page for a browser");
        command->add_flag("--json", options->json, "write the result as JSON");
        command->callback([options] { run(*options); });
    }};
}

}  // namespace vantage
