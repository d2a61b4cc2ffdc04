#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "calib_tools/commands/board_options.h"
#include "calib_tools/commands/live_option.h"
#include "calib_tools/commands/rig_folders.h"
#include "calib_tools/commands/stage_pairs.h"
#include "calib_tools/live/board_film.h"
#include "calib_tools/plots/html_page.h"
#include "calib_tools/report/calibration_page.h"
#include "calib_tools/report/calibration_text.h"
#include "calib_tools/stage/stage_calibration.h"
#include "calib_tools/stage/stage_report.h"
#include "common/base/cli/command.h"
#include "common/base/error.h"
#include "common/base/files/folder.h"
#include "common/base/log.h"
#include "common/board/median.h"
#include "common/config/calibration_file.h"
#include "common/image/picture_list.h"

namespace vantage {
namespace {

std::string drawing(const StageCalibration& stage) {
    std::vector<PlacedRig> rigs;
    for (const StageCalibration::Rig& rig : stage.rigs) {
        const CameraModel& left = rig.calibration.left;
        rigs.push_back({rig.name, rig.calibration.world_from_left,
                        2 * std::atan(0.5 * left.width_px / left.fx_px), rig.translation_sigma_m});
    }
    std::vector<RigTie> ties;
    for (const StageCalibration::Tie& tie : stage.ties)
        if (tie.shared > 0)
            ties.push_back({tie.a, tie.b, std::to_string(tie.shared),
                            tie.shared < StageCalibration::few_shared});
    return draw_stage(rigs, ties, stage.has_floor);
}

/// Result as a page: the stage from above, every rig's pose with its uncertainty, connections,
/// reprojection errors and residual per frame set.
HtmlPage stage_page(const StageCalibration& stage) {
    // 1 mm and 0.02 degrees correspond to one pixel of a rig's image at 4 m.
    constexpr double warn_mm = 1, bad_mm = 4, warn_deg = 0.02, bad_deg = 0.1;
    HtmlPage page("Calibration of a stage");
    page.paragraph(date_now());
    page.paragraph(fmt::format("Reprojection {:.3f} px RMS; {} of {} instants used; world: {}.",
                               stage.rms_px, stage.instants_used, stage.instants_given,
                               stage.has_floor ? "the board on the floor, y up"
                                               : "the first rig is taken to stand level at 1.6 m"));
    page.figure(drawing(stage),
                "The stage from above. Lines: instants that two rigs saw together (dashed: too "
                "few). Discs: uncertainty, a hundred times enlarged.");
    std::vector<std::vector<HtmlPage::Cell>> rows;
    for (const StageCalibration::Rig& rig : stage.rigs) {
        const Eigen::Vector3d at = rig.calibration.world_from_left.translation();
        const double mm = 1000 * rig.translation_sigma_m, deg = rig.rotation_sigma_deg();
        rows.push_back({{rig.name},
                        {fmt::format("{:.4f}, {:.4f}, {:.4f}", at.x(), at.y(), at.z())},
                        {fmt::format("{:.2f}", mm), mark_of(mm, warn_mm, bad_mm)},
                        {fmt::format("{:.4f}", deg), mark_of(deg, warn_deg, bad_deg)},
                        {fmt::format("{:.3f}", rig.rms_px)},
                        {std::to_string(rig.instants)},
                        {rig.refined ? fmt::format("{:.3f} %", 100 * rig.focal_change) : "held"}});
    }
    page.heading("Rigs");
    page.table({"rig", "place x, y, z (m)", "± mm", "± degrees", "px RMS", "instants",
                "focal length refined by"},
               rows);
    std::vector<std::vector<HtmlPage::Cell>> faces;
    for (const StageCalibration::Body& body : stage.bodies)
        for (std::size_t i = 0; i < body.body_from_board.size(); ++i) {
            const Eigen::Vector3d at = body.body_from_board[i].translation();
            faces.push_back({{body.name},
                             {std::to_string(body.boards[i] + 1)},
                             {fmt::format("{:.4f}, {:.4f}, {:.4f}", at.x(), at.y(), at.z())},
                             {fmt::format("{:.2f}", 1000 * body.translation_sigma_m[i])}});
        }
    if (!faces.empty()) {
        page.heading("Boards that are fixed to each other");
        page.table({"body", "board", "place x, y, z (m)", "± mm"}, faces);
    }
    page.heading("Residuals");
    for (std::size_t i = 0; i < stage.bundle.cameras.size(); ++i) {
        const CameraModel& m = stage.bundle.cameras[i].model;
        page.figure(draw_vectors(m.width_px, m.height_px,
                                 reprojection_vectors(stage.bundle, static_cast<int>(i))),
                    fmt::format("Rig {}, {} camera", stage.rigs[i / 2].name,
                                i % 2 == 0 ? "left" : "right"));
    }
    std::vector<Bar> bars;
    std::vector<double> values;
    for (std::size_t b = 0; b < stage.placements.size(); ++b) {
        double squares = 0, corners = 0;
        for (const BundleView& view : stage.bundle.views) {
            if (view.board != static_cast<int>(b)) continue;
            const auto count = static_cast<double>(view.corners.size());
            squares += std::pow(stage.bundle.view_rms_px(view), 2) * count;
            corners += count;
        }
        if (corners == 0) continue;
        values.push_back(std::sqrt(squares / corners));
        bars.push_back({stage.bodies.size() == 1 ? std::to_string(stage.placements[b].instant)
                                                 : stage.placement_name(static_cast<int>(b)),
                        values.back()});
    }
    page.figure(draw_bars(bars, "px RMS", median(values)),
                "Residual of every instant; dashed: the usual one.");
    if (const std::string next = next_picture_sentence(stage); !next.empty())
        page.paragraph(next + ".");
    add_refusals(page, stage.rejected, stage.advice);
    return page;
}

struct StageOptions {
    BoardOptions board;
    std::vector<std::string> rigs;
    std::string output, floor_board;
    long long floor = -1;
    bool hold_lenses = false, floor_first = false;
    LiveOption live;
    std::string html;
    bool json = false;
    std::string pairs;
    StagePairsOptions single_cameras;
};

/// Board sightings by frame set. Images without the board, and images with another size than the
/// calibration, are added to the rejected ones with the reason.
std::map<long long, BoardCorners> by_instant(const std::vector<SeenPicture>& pictures,
                                             const std::vector<long long>& numbers,
                                             const StageRig& rig, const CameraModel& camera,
                                             StageCalibration& notes) {
    std::map<long long, BoardCorners> seen;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        const SeenPicture& p = pictures[i];
        if (!p.sighting.found()) {
            notes.rejected.push_back({rig.name + ": " + p.name(), p.sighting.reason});
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

std::map<long long, BoardCorners> sightings(const std::string& pattern_of_files,
                                            const CalibrationBoards& boards, const StageRig& rig,
                                            const CameraModel& camera, StageCalibration& notes) {
    const std::vector<std::filesystem::path> files = expand_pictures(pattern_of_files);
    const std::vector<long long> numbers = picture_numbers(files);
    if (numbers.empty())
        fail("'{}': every picture needs a number in its name that tells its instant",
             pattern_of_files);
    std::vector<SeenPicture> pictures = look_at_pictures(files, boards);
    refuse_wrong_board(pictures, boards);
    return by_instant(pictures, numbers, rig, camera, notes);
}

struct LiveFilm {
    long long first_pulse = 0;
    std::string kept;  ///< see BoardFilm::kept
};

/// Films the board live and gives every rig its sightings.
LiveFilm film_live(const StageOptions& options, const CalibrationBoards& boards,
                   const std::vector<RigFolder>& folders, std::vector<StageRig>& rigs,
                   StageCalibration& notes) {
    LiveRigs live = options.live.connect(folders);
    std::vector<FilmedCamera> cameras;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < rigs.size(); ++i) {
        names.push_back(rigs[i].name);
        for (const bool is_left : {true, false})
            cameras.push_back(
                {i, is_left, rigs[i].name + (is_left ? " left" : " right"), folders[i].folder});
    }
    if (options.floor_first)
        log_info(
            "lay the board on the floor, face up: the first instant kept is the world's floor");
    const bool floor_is_filmed = options.floor_first && !options.live.go_on;
    const BoardFilm film = film_board(
        live, cameras, boards, options.live.film(),
        floor_is_filmed ? floor_first(boards, options.floor_board) : two_rigs_see_board(boards),
        tie_advice(boards, names));
    const std::vector<long long> numbers(film.pulses.begin(), film.pulses.end());
    for (std::size_t i = 0; i < rigs.size(); ++i) {
        StageRig& rig = rigs[i];
        rig.left = by_instant(film.pictures[2 * i], numbers, rig, rig.calibration.left, notes);
        rig.right =
            by_instant(film.pictures[2 * i + 1], numbers, rig, rig.calibration.right, notes);
    }
    return {numbers.front(), film.kept};
}

void run(const StageOptions& options) {
    if (!options.pairs.empty()) {
        StagePairsOptions pairs = options.single_cameras;
        pairs.output = options.output;
        pairs.json = options.json;
        form_stage_pairs(pairs);
        return;
    }
    if (options.rigs.empty())
        fail("which rigs? give --rig NAME=FOLDER for each, or --pairs auto for single cameras");
    const CalibrationBoards boards = options.board.boards();
    std::vector<StageRig> rigs;
    StageCalibration notes;
    std::optional<Floor> floor;
    std::string kept;
    if (options.floor >= 0) floor = Floor(options.floor, options.floor_board);
    const std::vector<RigFolder> folders = parse_rig_folders(options.rigs);
    for (const auto& [name, folder] : folders) {
        StageRig rig;
        rig.name = name;
        rig.calibration = load_calibration(folder / "calibration.yaml");
        const CalibrationRecord record = load_calibration_record(folder / "calibration.yaml");
        rig.alpha = record.alpha;
        if (!options.hold_lenses) rig.sigma = record.sigma;
        if (!options.live.given()) {
            rig.left =
                sightings((folder / "left*").string(), boards, rig, rig.calibration.left, notes);
            rig.right =
                sightings((folder / "right*").string(), boards, rig, rig.calibration.right, notes);
        }
        rigs.push_back(std::move(rig));
    }
    if (options.live.given()) {
        LiveFilm film = film_live(options, boards, folders, rigs, notes);
        if (options.floor_first) floor = Floor(film.first_pulse, options.floor_board);
        kept = std::move(film.kept);
    }
    for (const StageRig& rig : rigs)
        log_info("rig {}: the board in {} left and {} right pictures", rig.name, rig.left.size(),
                 rig.right.size());
    StageCalibration stage =
        with_kept_film(kept, [&] { return calibrate_stage(rigs, boards, floor); });
    stage.rejected.insert(stage.rejected.end(), notes.rejected.begin(), notes.rejected.end());
    make_folder(options.output);
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
        CLI::App* command =
            program.add_subcommand("stage",
                                   "Find the place of every rig, from pictures of a board that "
                                   "several rigs see at the same moment");
        const auto options = std::make_shared<StageOptions>();
        options->board.add_to(*command);
        command->add_option("--rig", options->rigs,
                            "Folder of a rig, given as NAME=FOLDER, with calibration.yaml, "
                            "left*N.png and right*N.png; equal N are the same moment; --live "
                            "stores the pictures there; repeat the option for each rig");
        command->add_option("--floor", options->floor,
                            "Put the world's origin where the board lies on the floor in the "
                            "pictures with this number");
        command->add_option("--floor-board", options->floor_board,
                            "Of several boards, the one with this name lies on the floor; the name "
                            "is that of its description without extension");
        options->live.add_film_to(*command);
        command->add_flag("--floor-first", options->floor_first,
                          "With --live: put the world's origin where the board lies on the floor "
                          "in the first pictures kept");
        command->add_flag("--hold-lenses", options->hold_lenses,
                          "Keep the lenses and baselines of each rig's calibration, and solve only "
                          "the rigs' places");
        command
            ->add_option("-o,--output", options->output,
                         "Write NAME.yaml for each rig to this folder")
            ->required();
        PairLimits& limits = options->single_cameras.limits;
        CLI::Option* pairs =
            command
                ->add_option(
                    "--pairs", options->pairs,
                    "auto: form stereo rigs from the [[cameras]] of --stage that stand near "
                    "enough, and write a calibration and a rig file for each, and a stage file")
                ->check(CLI::IsMember({"auto"}));
        CLI::Option* stage =
            command
                ->add_option("--stage", options->single_cameras.stage,
                             "With --pairs: read the [[cameras]] of this stage file")
                ->needs(pairs);
        pairs->needs(stage);
        command
            ->add_option("--most-angle-deg", limits.most_angle_deg,
                         "With --pairs: set the largest angle between the axes of a pair")
            ->needs(pairs)
            ->check(CLI::Range(1.0, 60.0))
            ->capture_default_str();
        command
            ->add_option("--least-overlap", limits.least_overlap,
                         "With --pairs: set the smallest share of the view that both cameras have "
                         "in common at the middle of the stage")
            ->needs(pairs)
            ->check(CLI::Range(0.05, 1.0))
            ->capture_default_str();
        command
            ->add_option("--most-baseline-share", limits.most_baseline_share,
                         "With --pairs: set the largest baseline, relative to the distance of the "
                         "middle of the stage")
            ->needs(pairs)
            ->check(CLI::Range(0.01, 2.0))
            ->capture_default_str();
        command->add_option("--html", options->html, "Write a report for a browser to this file");
        command->add_flag("--json", options->json, "Print the result as JSON");
        command->callback([options] { run(*options); });
    }};
}

}  // namespace vantage
