#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/base/cli/command.h"
#include "host_app/control/table/lamp.h"

namespace vantage {

CommandEntry control_command_entry() {
    return {[](CLI::App& program) {
        auto json = std::make_shared<bool>(false);
        CLI::App* command = program.add_subcommand(
            "control", "List the commands and lamps of a show, for keys and remote control alike");
        command->add_flag("--json", *json, "Print them as one JSON object");
        command->footer(
            "Keys, jog maps, OSC, RossTalk and MIDI all use this list; see vantage live "
            "--control.");
        command->callback([json] {
            if (*json)
                std::cout << control_json().dump() << '\n';
            else
                for (const ControlPage page : {ControlPage::replay, ControlPage::control})
                    std::cout << (page == ControlPage::replay ? "" : "\n") << command_table(page)
                              << '\n'
                              << lamp_table(page);
        });
    }};
}

}  // namespace vantage
