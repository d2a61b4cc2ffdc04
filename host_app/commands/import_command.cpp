#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/base/cli/command.h"
#include "common/base/cli/print_result.h"
#include "host_app/view_sets/view_set.h"

namespace vantage {
namespace {

struct ImportOptions {
    std::string folder, view_set;
    int instant = 0;
    std::vector<double> depth_range;
    bool json = false;
};

void print(const ImportedViews& imported, const ImportOptions& options) {
    print_result(nlohmann::ordered_json{{"view_set", options.view_set},
                                        {"views", imported.views},
                                        {"with_geometry", imported.with_geometry}},
                 options.json);
}

CLI::App* add_data_set(CLI::App& import, const std::string& name, const std::string& summary,
                       const std::shared_ptr<ImportOptions>& options) {
    CLI::App* command = import.add_subcommand(name, summary);
    command->add_option("DIR", options->folder, "Folder of the data set")->required();
    command->add_option("-o,--output", options->view_set, "Write the view set to this folder")
        ->required();
    command->add_flag("--json", options->json, "Print the result as one JSON object");
    return command;
}

}  // namespace

CommandEntry import_command_entry() {
    return {[](CLI::App& program) {
        auto options = std::make_shared<ImportOptions>();
        CLI::App* import =
            program.add_subcommand("import", "Convert a published data set to a view set");
        import->require_subcommand(1);

        CLI::App* microsoft = add_data_set(
            *import, "msr3dvideo", "Microsoft Research 3-D video: ballet, breakdancers", options);
        auto* instant = microsoft
                            ->add_option("--instant", options->instant,
                                         "Import the instant of this number in the file names "
                                         "(default: the first with a depth map)")
                            ->check(CLI::NonNegativeNumber);
        microsoft
            ->add_option("--depth-range", options->depth_range,
                         "Set MinZ and MaxZ of the depth codes, for other sequences than these two")
            ->expected(2);
        microsoft->callback([options, instant] {
            std::optional<int> wanted;
            if (instant->count() > 0) wanted = options->instant;
            std::optional<std::pair<double, double>> range;
            if (!options->depth_range.empty())
                range.emplace(options->depth_range[0], options->depth_range[1]);
            print(import_msr3dvideo(options->folder, options->view_set, wanted, range), *options);
        });

        CLI::App* middlebury =
            add_data_set(*import, "middlebury",
                         "Middlebury stereo scenes of 2001, 2003, 2005, 2006, 2014", options);
        middlebury->callback(
            [options] { print(import_middlebury(options->folder, options->view_set), *options); });
    }};
}

}  // namespace vantage
