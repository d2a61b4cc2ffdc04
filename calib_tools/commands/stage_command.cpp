#include <filesystem>
#include <iostream>
#include <memory>

#include "calib_tools/commands/board_options.h"
#include "calib_tools/commands/rig_folders.h"
#include "calib_tools/pictures/picture_list.h"
#include "calib_tools/report/calibration_text.h"
#include "calib_tools/stage/stage_calibration.h"
#include "calib_tools/stage/stage_page.h"
#include "calib_tools/stage/stage_report.h"
#include "common/base/command.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/config/calibration_file.h"

namespace vantage {
namespace {

struct Options {
    BoardOptions board;
    std::vector<std::string> rigs;
    std::string output;
    long long floor = -1;
    bool hold_lenses = false;
    std::string html;
    bool json = false;
};

std::map<long long, BoardCorners> sightings(const std::string& pattern_of_files,
                                            const BoardPattern& pattern, const StageRig& rig,
                                            const CameraModel& camera, StageCalibration& notes) {
    const std::vector<std::filesystem::path> files = expand_pictures(pattern_of_files);
    const std::vector<long long> numbers = picture_numbers(files);
    if (numbers.empty())
        fail("'{}': every picture needs a number in its name that tells its instant",
             pattern_of_files);
    std::vector<SeenPicture> pictures = look_at_pictures(files, pattern);
    refuse_wrong_board(pictures, pattern);
    std::map<long long, BoardCorners> seen;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        const SeenPicture& p = pictures[i];
        if (!p.sighting.found()) {
            // A rig that does not see the board at an instant is the rule on a wide stage.
            log_debug("{}: {} {}", rig.name, p.name(), p.sighting.reason);
            continue;
        }
        if (p.width_px != camera.width_px || p.height_px != camera.height_px) {
            notes.rejected.push_back(
                {rig.name + ": " + p.name(),
                 fmt::format("is {}x{} where the rig's calibration is for {}x{}", p.width_px,
                             p.height_px, camera.width_px, camera.height_px)});
            continue;
        }
        seen[numbers[i]] = p.sighting.corners;
    }
    return seen;
}

void run(const Options& options) {
    const BoardPattern pattern = options.board.pattern();
    std::vector<StageRig> rigs;
    StageCalibration notes;
    for (const auto& [name, folder] : parse_rig_folders(options.rigs)) {
        StageRig rig;
        rig.name = name;
        rig.calibration = load_calibration(folder / "calibration.yaml");
        const CalibrationRecord record = load_calibration_record(folder / "calibration.yaml");
        rig.alpha = record.alpha;
        if (!options.hold_lenses) rig.sigma = record.sigma;
        rig.left =
            sightings((folder / "left*").string(), pattern, rig, rig.calibration.left, notes);
        rig.right =
            sightings((folder / "right*").string(), pattern, rig, rig.calibration.right, notes);
        log_info("rig {}: the board in {} left and {} right pictures", rig.name, rig.left.size(),
                 rig.right.size());
        rigs.push_back(std::move(rig));
    }
    StageCalibration stage = calibrate_stage(
        rigs, pattern, options.floor >= 0 ? std::optional(options.floor) : std::nullopt);
    stage.rejected.insert(stage.rejected.end(), notes.rejected.begin(), notes.rejected.end());
    std::filesystem::create_directories(options.output);
    for (std::size_t i = 0; i < stage.rigs.size(); ++i) {
        const StageCalibration::Rig& rig = stage.rigs[i];
        const std::filesystem::path file =
            std::filesystem::path(options.output) / (rig.name + ".yaml");
        save_calibration(file, rig.calibration,
                         {.date = date_now(),
                          .tool = "vantage-calib stage",
                          .rms_px = rig.rms_px,
                          .row_rms_px = 0,
                          .views_used = rig.instants,
                          .alpha = rigs[i].alpha,
                          .sigma = rig.refined ? rig.sigma : rigs[i].sigma});
        log_info("{} written", file.string());
    }
    if (!options.html.empty()) {
        stage_page(stage).save(options.html);
        log_info("{} written", options.html);
    }
    if (options.json)
        std::cout << to_json(stage).dump(2) << '\n';
    else
        std::cout << describe(stage);
}

}  // namespace

CommandEntry stage_command_entry() {
    return {[](CLI::App& program) {
        CLI::App* command = program.add_subcommand(
            "stage",
            "Find where every rig stands, from pictures of a board that rigs saw together");
        const auto options = std::make_shared<Options>();
        options->board.add_to(*command);
        command
            ->add_option("--rig", options->rigs,
                         "NAME=FOLDER, once a rig: calibration.yaml, left*N.png and right*N.png; "
                         "equal numbers are equal instants")
            ->required();
        command->add_option("--floor", options->floor,
                            "number of the pictures in which the board lies on the floor, at the "
                            "world's origin");
        command->add_flag("--hold-lenses", options->hold_lenses,
                          "leave lenses and baselines as each rig's own calibration has them");
        command->add_option("-o,--output", options->output, "folder for one NAME.yaml a rig")
            ->required();
        command->add_option("--html", options->html, "report to write, a page for a browser");
        command->add_flag("--json", options->json, "write the result as JSON");
        command->callback([options] { run(*options); });
    }};
}

}  // namespace vantage
