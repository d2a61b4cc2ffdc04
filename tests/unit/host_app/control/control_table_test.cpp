#include <cmath>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "host_app/control/table/control_command.h"
#include "host_app/control/table/lamp.h"
#include "tests/support/source_folder.h"
#include "tests/unit/host_app/flight/given_commands.h"

namespace vantage {
namespace {

TEST(ControlTable, EveryCommandHasAnEffectAndAUniqueName) {
    std::set<std::string> names, keys;
    std::set<std::string> lamp_names;
    for (const Lamp& lamp : lamps()) EXPECT_TRUE(lamp_names.insert(lamp.name).second) << lamp.name;
    for (const ControlCommand& command : control_commands()) {
        EXPECT_TRUE(names.insert(command.name).second) << command.name;
        const std::string words = key_words(command);
        EXPECT_TRUE(words.empty() || keys.insert(words).second) << words << " has two commands";
        const std::string lamp = command.lamp;
        EXPECT_TRUE(lamp.empty() || lamp_names.contains(lamp) || lamp_names.contains(lamp + "/1"))
            << command.name << " has the lamp " << lamp;
        FlightInput input;
        apply({&command, 1, "words"}, input);
        EXPECT_TRUE(input.is_any()) << command.name;
    }
}

TEST(ControlTable, ArgumentsHaveToFit) {
    const ControlCommand& live = *find_command("live");
    EXPECT_TRUE(call_of(live, std::nullopt));
    EXPECT_FALSE(call_of(live, 1));
    const ControlCommand& shot = *find_command("shot");
    EXPECT_TRUE(call_of(shot, 9));
    for (const double wrong : {0.0, 1.5, 10.0, -1.0, std::nan("")})
        EXPECT_FALSE(call_of(shot, wrong)) << wrong;
    EXPECT_FALSE(call_of(shot, std::nullopt));
    const ControlCommand& orbit = *find_command("orbit");
    EXPECT_TRUE(call_of(orbit, -360));
    for (const double wrong : {361.0, std::nan(""), HUGE_VAL}) EXPECT_FALSE(call_of(orbit, wrong));
    EXPECT_EQ(find_command("no_such"), nullptr);
}

TEST(ControlTable, JogMapsNameItsCommands) {
    EXPECT_EQ(parse_button_command("shot 3")->argument, 3);
    EXPECT_STREQ(parse_button_command("output 8")->command->name, "output");
    for (const char* wrong : {"shot", "shot 0", "shot 10", "shot 3x", "shot  3", "live 1", "orbit",
                              "orbit 3", "Live", ""})
        EXPECT_FALSE(parse_button_command(wrong)) << wrong;
    for (const std::string& name : button_commands())
        EXPECT_TRUE(parse_button_command(name)) << name;
}

TEST(ControlTable, OldNamesOfCommandsStillWork) {
    EXPECT_EQ(find_command("learn_set"), find_command("learn_background"));            // old name
    EXPECT_EQ(find_command("save_set"), find_command("save_background"));              // old name
    EXPECT_STREQ(parse_button_command("save_set")->command->name, "save_background");  // old name
    std::set<std::string> names;
    for (const Lamp& lamp : lamps())
        for (const std::string name : {lamp.name, lamp.old_name})
            EXPECT_TRUE(name.empty() || names.insert(name).second) << name;
    for (const char* old : {"set", "saved_set", "hands_preview"})  // old name
        EXPECT_TRUE(names.contains(old)) << old;
}

TEST(ControlTable, DescribesKeys) {
    EXPECT_EQ(key_words(*find_command("freeze")), "Space");
    EXPECT_EQ(key_words(*find_command("store")), "Ctrl + 1 .. 9");
    EXPECT_EQ(key_words(*find_command("output")), "F5 .. F12");
    EXPECT_EQ(key_words(*find_command("orbit")), "");
}

TEST(ControlTable, RejectsTextThatCannotBeShown) {
    const ControlCommand& name = *find_command("name_clip");
    EXPECT_EQ(call_of(name, "the leap")->words, "the leap");
    for (const std::string& wrong : {std::string(), std::string(41, 'x'), std::string("a\nb")})
        EXPECT_FALSE(call_of(name, wrong)) << wrong;
    EXPECT_FALSE(call_of(name, 3.0));
    EXPECT_FALSE(call_of(*find_command("live"), "now"));
}

TEST(ControlTable, ReplayCommandsKeepTheirOrder) {
    FlightInput input;
    for (const char* words : {"preset 25", "make_clip", "name_clip leap"})
        apply(parse_typed_command(words), input);
    const std::vector<ReplayCall> calls = replay_calls(input);
    ASSERT_EQ(calls.size(), 3u);
    EXPECT_EQ(calls[0].action, ReplayAction::preset_speed);
    EXPECT_EQ(calls[0].number, 25);
    EXPECT_EQ(calls[2].words, "leap");
}

TEST(ControlTable, MatchesTheDocuments) {
    std::ostringstream document;
    document << std::ifstream(source_folder() / "docs/reference/commands.md").rdbuf();
    for (const ControlPage page : {ControlPage::control, ControlPage::replay})
        for (const std::string& table : {command_table(page), lamp_table(page)})
            EXPECT_NE((document.str() + "\n").find("\n\n" + table + "\n"), std::string::npos)
                << "docs/reference/commands.md must contain what `vantage control` writes (run "
                   "tools/reference.sh):\n"
                << table;
    const nlohmann::json json = control_json();
    EXPECT_EQ(json["commands"].size(), control_commands().size());
    EXPECT_EQ(json["lamps"].size(), lamps().size());
}

TEST(Lamps, ShowTheSession) {
    ShowLamps show;
    show.live = true;
    show.outputs[7] = "on";
    const auto value = [&](std::string_view name) {
        for (const Lamp& lamp : lamps())
            if (name == lamp.name) return lamp.of(show);
        return LampValue("there is no such lamp");
    };
    EXPECT_EQ(value("live"), LampValue(true));
    EXPECT_EQ(value("hold"), LampValue(false));
    EXPECT_EQ(value("output/8"), LampValue("on"));
    EXPECT_EQ(value("coverage"), LampValue(-1.0));
}

}  // namespace
}  // namespace vantage
