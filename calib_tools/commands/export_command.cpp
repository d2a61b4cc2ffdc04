#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/base/cli/command.h"
#include "common/base/cli/print_result.h"
#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/files/folder.h"
#include "common/calibration_forms/calibration_form.h"
#include "common/config/calibration_file.h"

namespace vantage {
namespace {

struct ForeignExportOptions {
    std::string calibration, form, output;
    bool json = false;
};

void export_foreign(const ForeignExportOptions& options) {
    const StereoCalibration calibration = load_calibration(options.calibration);
    for (const CalibrationForm& form : calibration_forms()) {
        if (form.name != options.form || !form.write) continue;
        const std::vector<FormText> texts = form.write(calibration);
        const bool is_one = texts.size() == 1;
        if (!is_one) make_folder(options.output);
        nlohmann::ordered_json written = nlohmann::ordered_json::array();
        for (const FormText& text : texts) {
            const std::filesystem::path path =
                is_one ? std::filesystem::path(options.output)
                       : std::filesystem::path(options.output) / text.name;
            write_text_atomically(path, text.text);
            written.push_back(path.string());
        }
        print_result(nlohmann::ordered_json{{"program", form.program}, {"files", written}},
                     options.json);
        return;
    }
    fail("no form '{}' is written", options.form);
}

}  // namespace

CommandEntry export_command_entry() {
    return {[](CLI::App& program) {
        CLI::App* command = program.add_subcommand(
            "export", "Convert a calibration of Vantage to the format of another program");
        const auto options = std::make_shared<ForeignExportOptions>();
        command->add_option("CALIB.yaml", options->calibration, "Calibration file of a rig")
            ->required();
        std::vector<std::string> forms;
        for (const CalibrationForm& form : calibration_forms())
            if (form.write) forms.push_back(form.name);
        command->add_option("--as", options->form, "Write this format")
            ->required()
            ->check(CLI::IsMember(forms));
        command
            ->add_option("-o,--output", options->output,
                         "Write this file; for ros and colmap, a folder")
            ->required();
        command->add_flag("--json", options->json, "Print the result as JSON");
        command->callback([options] { export_foreign(*options); });
    }};
}

}  // namespace vantage
