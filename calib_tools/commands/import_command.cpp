#include <filesystem>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "calib_tools/interchange/calibration_import.h"
#include "calib_tools/report/calibration_text.h"
#include "common/base/cli/command.h"
#include "common/base/counted.h"
#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/files/folder.h"
#include "common/base/log.h"
#include "common/config/calibration_file.h"
#include "common/config/intrinsics_file.h"
#include "common/image/image_file.h"

namespace vantage {
namespace {

struct ForeignImportOptions {
    std::vector<std::string> files, check;
    std::string output, unit;
    std::vector<int> size;
    ImportSettings settings;
    std::string up = "y";
    bool all = false, json = false;
};

double metres_per(const std::string& unit) {
    if (unit == "mm") return 0.001;
    if (unit == "cm") return 0.01;
    if (unit == "inch") return 0.0254;
    return unit == "m" ? 1 : 0;
}

std::vector<FormFile> load_form_files(const std::vector<std::string>& names) {
    std::vector<FormFile> files;
    for (const std::string& name : names) {
        // A COLMAP model is a folder.
        if (std::filesystem::is_directory(name)) {
            for (const char* part : {"cameras.txt", "images.txt"})
                files.push_back(load_form_file(std::filesystem::path(name) / part));
        } else {
            files.push_back(load_form_file(name));
        }
    }
    return files;
}

void describe_import(const ImportedCalibration& imported, const std::optional<RowAgreement>& rows) {
    std::string text = fmt::format("Taken from a calibration of {}:\n", imported.program);
    for (const std::string& sentence : imported.taken) text += "  " + sentence + '\n';
    text += "Assumed:\n";
    for (const std::string& sentence : imported.assumed) text += "  " + sentence + '\n';
    if (!imported.left_out.empty()) text += "Left out:\n";
    for (const std::string& sentence : imported.left_out) text += "  " + sentence + '\n';
    if (rows)
        text += fmt::format(
            "Checked on pictures: {} features are {:.2f} px from their rows (median; RMS {:.2f} "
            "px)\n",
            rows->features, rows->median_px, rows->rms_px);
    std::cout << text;
}

/// Writes a lens file for each camera, and a stage file with their places.
void import_all(const ForeignImportOptions& options, const std::vector<FormFile>& files,
                const ImportSettings& settings) {
    if (!options.check.empty()) fail("--check is for a rig, and --all takes single cameras");
    const ImportedCameras imported = import_cameras(files, settings, options.up);
    const std::filesystem::path folder = options.output;
    make_folder(folder);
    const std::string tool = fmt::format("vantage-calib import, from {}", imported.program);
    std::string stage = fmt::format("# Written by {}.\nversion = 1\n", tool);
    nlohmann::ordered_json names = nlohmann::ordered_json::array();
    for (const SingleCamera& camera : imported.cameras) {
        const std::string file = camera.name + ".yaml";
        save_intrinsics(folder / file, camera.model, record_of_foreign_lens(camera.model, tool));
        stage += '\n' + stage_camera_text(camera, file);
        names.push_back(camera.name);
    }
    write_text_atomically(folder / "stage.toml", stage);
    log_info("{} and {} written", (folder / "stage.toml").string(),
             counted(imported.cameras.size(), "lens file"));
    if (options.json) {
        std::cout << nlohmann::ordered_json{{"path", (folder / "stage.toml").string()},
                                            {"program", imported.program},
                                            {"cameras", names},
                                            {"taken", imported.taken},
                                            {"assumed", imported.assumed},
                                            {"left_out", imported.left_out}}
                         .dump(2)
                  << '\n';
        return;
    }
    ImportedCalibration report;
    report.program = imported.program;
    report.taken = imported.taken;
    report.assumed = imported.assumed;
    report.left_out = imported.left_out;
    describe_import(report, std::nullopt);
    std::cout << "Next: name each camera's 'source' in the stage file, then form rigs with\n"
                 "  vantage-calib stage --pairs auto --stage "
              << (folder / "stage.toml").string() << " -o FOLDER\n";
}

void import_foreign(const ForeignImportOptions& options) {
    ImportSettings settings = options.settings;
    settings.metres_per_unit = metres_per(options.unit);
    if (!options.size.empty()) settings.form.size_px = cv::Size(options.size[0], options.size[1]);
    const std::vector<FormFile> files = load_form_files(options.files);
    if (options.all) {
        import_all(options, files, settings);
        return;
    }
    ImportedCalibration imported = import_calibration(files, settings);
    std::optional<RowAgreement> rows;
    if (!options.check.empty()) {
        if (!imported.rig) fail("--check needs a rig, and the files hold one camera");
        const auto [left, right] = read_colour_pair(options.check[0], options.check[1]);
        rows = check_rows(*imported.rig, left, right);
        if (const std::optional<double> offset_px =
                correct_row_offset(*imported.rig, settings.alpha, left, right, *rows)) {
            imported.assumed.push_back(fmt::format(
                "the rows of the right picture lie {:.2f} px {} than the file says, all alike: "
                "its principal point is moved by as much",
                std::abs(*offset_px), *offset_px > 0 ? "lower" : "higher"));
            // The place that was assumed depends on the rectification.
            assume_place(*imported.rig);
        }
    }
    const std::string tool = fmt::format("vantage-calib import, from {}", imported.program);
    if (imported.rig)
        save_calibration(options.output, *imported.rig,
                         {.date = date_now(),
                          .tool = tool,
                          .row_rms_px = rows ? rows->rms_px : 0,
                          .alpha = settings.alpha});
    else
        save_intrinsics(options.output, imported.camera,
                        record_of_foreign_lens(imported.camera, tool));
    log_info("{} written", options.output);
    if (options.json) {
        nlohmann::ordered_json json{{"path", options.output},
                                    {"program", imported.program},
                                    {"is_rig", imported.rig.has_value()},
                                    {"taken", imported.taken},
                                    {"assumed", imported.assumed},
                                    {"left_out", imported.left_out}};
        if (rows)
            json["rows"] = {{"features", rows->features},
                            {"median_px", rows->median_px},
                            {"rms_px", rows->rms_px}};
        std::cout << json.dump(2) << '\n';
    } else {
        describe_import(imported, rows);
    }
    constexpr double good_rows_px = 1;
    if (rows && rows->median_px > good_rows_px)
        log_warning(
            "the rows of the pictures disagree by {:.2f} px, more than {} px: the calibration is "
            "of other cameras, of another size, or in another convention",
            rows->median_px, good_rows_px);
}

std::string known_programs() {
    std::vector<std::string> names;
    for (const CalibrationForm& form : calibration_forms()) names.push_back(form.program);
    return fmt::format("{}", fmt::join(names, "; "));
}

}  // namespace

CommandEntry import_command_entry() {
    return {[](CLI::App& program) {
        CLI::App* command = program.add_subcommand(
            "import",
            "Convert the calibration files of another program to a calibration of Vantage");
        const auto options = std::make_shared<ForeignImportOptions>();
        command
            ->add_option("FILE", options->files,
                         "Files of one calibration, or the folder of a COLMAP model; known are: " +
                             known_programs())
            ->required();
        command
            ->add_option("-o,--output", options->output,
                         "Write this calibration file (YAML); with --all, this folder")
            ->required();
        command->add_option(
            "--left", options->settings.left,
            "Take the camera with this name as the left one, if the files have several");
        command->add_option("--right", options->settings.right,
                            "Take the camera with this name as the right one");
        command->add_flag("--all", options->all,
                          "Import every camera as a single camera of a stage: write a lens file "
                          "for each, and stage.toml with their places, to the folder -o");
        command
            ->add_option("--up", options->up,
                         "With --all: set the axis of the file's world that points up")
            ->check(CLI::IsMember({"x", "y", "z", "-x", "-y", "-z"}))
            ->capture_default_str();
        command
            ->add_option("--unit", options->unit,
                         "Set the unit of the file's lengths, if its format defines none")
            ->check(CLI::IsMember({"m", "cm", "mm", "inch"}));
        command
            ->add_option("--baseline-m", options->settings.baseline_m,
                         "Set the scale by the measured distance between the cameras in metres")
            ->check(CLI::PositiveNumber);
        command
            ->add_option("--size", options->size,
                         "Set WIDTH and HEIGHT of the pictures, if the files do not state them")
            ->expected(2)
            ->delimiter('x')
            ->check(CLI::Range(1, 16384));
        command->add_flag("--fisheye", options->settings.form.is_fisheye,
                          "Use OpenCV's fisheye lens model, if the files do not state a model");
        command
            ->add_option(
                "--alpha", options->settings.alpha,
                "Crop the rectified picture: 0 keeps valid pixels only, 1 keeps all raw pixels")
            ->check(CLI::Range(0.0, 1.0))
            ->capture_default_str();
        command
            ->add_option(
                "--check", options->check,
                "Measure with this raw pair of the rig how well the rows of both pictures agree")
            ->expected(2)
            ->type_name("LEFT RIGHT");
        command->add_flag("--json", options->json, "Print the result as JSON");
        command->callback([options] { import_foreign(*options); });
    }};
}

}  // namespace vantage
