#include "host_app/control/table/control_words.h"

#include <fmt/format.h>

#include "host_app/control/table/lamp.h"

namespace vantage {

std::string command_table(ControlPage page) {
    std::string text = "| command | action | key | lamp |\n| --- | --- | --- | --- |\n";
    for (const ControlCommand& command : control_commands())
        if (command.page == page)
            text += fmt::format("| {}{} | {} | {} | {} |\n", command.name, argument_words(command),
                                command.does, key_words(command), command.lamp);
    return text;
}

std::string lamp_table(ControlPage page) {
    std::string text = "| lamp | meaning | type |\n| --- | --- | --- |\n";
    for (const Lamp& lamp : lamps())
        if (*lamp.says && lamp.page == page)
            text += fmt::format("| {} | {} | {} |\n", lamp.name, lamp.says, kind_words(lamp));
    return text;
}

nlohmann::ordered_json control_json() {
    nlohmann::ordered_json json;
    for (const ControlCommand& command : control_commands()) {
        nlohmann::ordered_json entry{{"name", command.name}, {"does", command.does}};
        if (command.argument == CommandArgument::words) entry["words"] = command.argument_name;
        if (command.argument == CommandArgument::number) entry["most"] = command.max_number;
        if (command.argument == CommandArgument::steps) entry["most_steps"] = most_steps;
        if (*command.old_name) entry["old_name"] = command.old_name;
        if (const std::string key = key_words(command); !key.empty()) entry["key"] = key;
        if (*command.lamp) entry["lamp"] = command.lamp;
        json["commands"].push_back(std::move(entry));
    }
    for (const Lamp& lamp : lamps()) {
        json["lamps"].push_back(
            {{"name", lamp.name}, {"says", lamp.says}, {"is", kind_words(lamp)}});
        if (*lamp.old_name) json["lamps"].back()["old_name"] = lamp.old_name;
    }
    return json;
}

}  // namespace vantage
