#include "common/base/command.h"

#include <exception>
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>

#include "common/base/error.h"
#include "common/base/log.h"

namespace vantage {

int run_program(std::string_view name, std::string_view description,
                const std::vector<CommandEntry>& commands, int argc, char** argv) {
    CLI::App program{std::string(description), std::string(name)};
    program.require_subcommand(1);
    program.set_version_flag("--version", VANTAGE_VERSION);
    for (const CommandEntry& command : commands) command.add(program);
    try {
        program.parse(argc, argv);
        std::cout.flush();
        if (!std::cout) fail("standard output could not be written");
        return 0;
    } catch (const CLI::Success& help_or_version) {
        return program.exit(help_or_version);
    } catch (const CLI::ParseError& error) {
        log_error("{}; {} --help lists what fits", error.what(), name);
        return 2;
    } catch (const std::exception& error) {
        log_error("{}", error.what());
        return 1;
    }
}

}  // namespace vantage
