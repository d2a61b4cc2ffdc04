#include "common/base/cli/command_tree.h"

#include <CLI/CLI.hpp>

namespace vantage {
namespace {

/// CLI11 keeps an option group as a subcommand without a name.
bool is_group(const CLI::App* app) { return app->get_name().empty(); }

}  // namespace

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App* command) { return !is_group(command); });
}

std::vector<const CLI::Option*> options_of(const CLI::App& app) {
    std::vector<const CLI::Option*> options = app.get_options({});
    for (const CLI::App* group : app.get_subcommands(is_group))
        for (const CLI::Option* option : group->get_options({}))
            if (option != group->get_help_ptr()) options.push_back(option);
    return options;
}

}  // namespace vantage
