#include "host_app/desk/panels/command_prompt.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

CommandPrompt typed(std::string_view words) {
    CommandPrompt prompt;
    prompt.open();
    for (const char c : words) prompt.type(static_cast<unsigned char>(c));
    return prompt;
}

TEST(CommandPrompt, ParsesTheTypedCommand) {
    CommandPrompt prompt = typed("clip_speed 50");
    const auto call = prompt.call();
    ASSERT_TRUE(call);
    EXPECT_STREQ(call->command->name, "clip_speed");
    EXPECT_EQ(call->argument, 50);
    EXPECT_TRUE(prompt.is_open()) << "until the command is executed";
    prompt.close();
    EXPECT_FALSE(prompt.is_open());
    EXPECT_EQ(typed("name_clip the leap").call()->words, "the leap");
    EXPECT_EQ(typed("orbit -12.5").call()->argument, -12.5);
}

TEST(CommandPrompt, ParsesATimeAlone) {
    for (const char* time : {"20:15:07:12", "-3.5", "12"}) {
        const auto call = typed(time).call();
        ASSERT_TRUE(call) << time;
        EXPECT_STREQ(call->command->name, "cue_time");
        EXPECT_EQ(call->words, time);
    }
}

TEST(CommandPrompt, ExplainsWhyTextIsNotACommand) {
    for (const auto& [words, why] : {std::pair("clip_sped 50", "did you mean clip_speed?"),
                                     {"clip_speed", "PERCENT (1 to 200)"},
                                     {"clip_speed 300", "1 to 200"},
                                     {"clip_speed 5x", "1 to 200"},
                                     {"live 3", "does not fit"},
                                     {"name_clip", "NAME"},
                                     {"", "no command"}}) {
        CommandPrompt prompt = typed(words);
        EXPECT_FALSE(prompt.call()) << words;
        EXPECT_NE(prompt.line().find(why), std::string::npos) << prompt.line();
    }
}

TEST(CommandPrompt, CompletesTheCommonPrefix) {
    CommandPrompt prompt = typed("last");
    prompt.complete();
    EXPECT_EQ(prompt.line(), "> last_cue_");
    CommandPrompt two = typed("entry_s");
    two.complete();
    EXPECT_EQ(two.line(), "> entry_speed_");
    CommandPrompt many = typed("frame");
    many.complete();
    EXPECT_EQ(many.line(), "> frame__");
    many.erase();
    EXPECT_EQ(many.line(), "> frame_");
}

TEST(CommandPrompt, IgnoresOtherCharacters) {
    CommandPrompt prompt;
    prompt.open();
    for (const unsigned codepoint : {7u, 0xe4u, 0x1f600u}) prompt.type(codepoint);
    EXPECT_EQ(prompt.line(), "> _");
    for (int i = 0; i < 1000; ++i) prompt.type('x');
    EXPECT_LT(prompt.line().size(), 80u);
}

}  // namespace
}  // namespace vantage
