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
#include "common/config/intrinsics_file.h"
#include "common/image/picture_list.h"

namespace vantage {
namespace {

struct IntrinsicsOptions {
    BoardOptions board;
    LensOption lens;
    LiveRigOption live;
    std::string side = "left";
    std::vector<std::string> pictures;
    std::string output;
    std::string html;
    bool json = false;
};

struct SeenSeries {
    std::vector<SeenPicture> pictures;
    std::string kept;  ///< see BoardFilm::kept
};

SeenSeries look(const IntrinsicsOptions& options, const BoardPattern& pattern) {
    if (!options.live.given()) {
        std::vector<std::string> pictures = options.pictures;
        if (pictures.empty() && !options.live.rig.empty())
            pictures = {options.live.kept_pictures(options.side)};
        if (pictures.empty())
            fail("which pictures? give --images, --rig NAME=FOLDER, or --live and --rig");
        if (const std::filesystem::path film = film_among(pictures); !film.empty())
            return {look_at_pictures(std::move(read_film_frames({film}).front()), pattern), {}};
        return {look_at_pictures(expand_pictures(pictures), pattern), {}};
    }
    const RigFolder rig = options.live.folder();
    LiveRigs rigs = options.live.connect({rig});
    BoardFilm film =
        film_board(rigs, {{0, options.side == "left", options.side, rig.folder}}, pattern,
                   options.live.film(), all_see_board, lens_advice({options.side}));
    return {std::move(film.pictures[0]), film.kept};
}

void run(const IntrinsicsOptions& options) {
    const BoardPattern pattern = options.board.pattern("--images");
    RigOptions rig_options;
    rig_options.family = options.lens.family();
    SeenSeries seen = look(options, pattern);
    const CameraCalibration result = with_kept_film(seen.kept, [&] {
        return calibrate_camera(std::move(seen.pictures), pattern, rig_options);
    });
    if (!options.output.empty()) {
        const Bundle& bundle = result.bundle;
        save_intrinsics(options.output, bundle.cameras.front().model,
                        {.date = date_now(),
                         .tool = "vantage-calib intrinsics",
                         .rms_px = bundle.rms_px(),
                         .views_used = static_cast<int>(result.views_used),
                         .sigma = camera_sigma(result.uncertainty.cameras.front())});
        log_info("{} written", options.output);
    }
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

CommandEntry intrinsics_command_entry() {
    return {[](CLI::App& program) {
        CLI::App* command = program.add_subcommand(
            "intrinsics", "Calibrate one camera's lens from pictures of a board");
        const auto options = std::make_shared<IntrinsicsOptions>();
        options->board.add_to(*command);
        options->lens.add_to(*command);
        command->add_option("--images", options->pictures,
                            "Read these pictures: 'PATTERN', a folder or files");
        options->live.add_to(*command);
        command->add_option("--side", options->side, "Calibrate this camera of --rig")
            ->check(CLI::IsMember({"left", "right"}))
            ->capture_default_str();
        command->add_option("-o,--output", options->output,
                            "Write this lens file (YAML, with the keys of OpenCV's samples)");
        command->add_option("--html", options->html, "Write a report for a browser to this file");
        command->add_flag("--json", options->json, "Print the result as JSON");
        command->callback([options] { run(*options); });
    }};
}

}  // namespace vantage
