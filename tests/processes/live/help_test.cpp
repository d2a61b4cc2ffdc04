#include <filesystem>
#include <regex>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/child_program.h"

namespace vantage {
namespace {

/// The packages install the documented examples elsewhere, so the help names both places.
TEST(Help, NamesTheExamplesOfSourcesAndPackages) {
    for (const char* program : {VANTAGE_PROGRAM, VANTAGE_RIG_PROGRAM}) {
        const ProgramResult page = run_to_end(program, {"--man-page"});
        ASSERT_EQ(page.status, 0) << page.err;
        const std::string words = std::regex_replace(page.out, std::regex("\\s+"), " ");
        const std::regex example("hw_config/([a-z_/]+(\\.toml)?)( .installed: ([a-z_/.]+))?");
        int named = 0;
        for (std::sregex_iterator at(words.begin(), words.end(), example), end; at != end; ++at) {
            ++named;
            const std::filesystem::path installed = (*at)[4].str();
            const std::filesystem::path folder = installed.parent_path();
            EXPECT_EQ(installed.filename(), (*at)[1].str()) << at->str();
            EXPECT_TRUE(folder == "/usr/share/doc/vantage/examples" || folder == "/etc/vantage")
                << at->str();
        }
        EXPECT_GE(named, 2) << program;
    }
}

TEST(Help, LeavesOldNamesOutOfTheCompletion) {
    const ProgramResult completion = run_to_end(VANTAGE_PROGRAM, {"--bash-completion"});
    ASSERT_EQ(completion.status, 0) << completion.err;
    EXPECT_NE(completion.out.find("--source-map"), std::string::npos);
    EXPECT_EQ(completion.out.find("--novelty"), std::string::npos);  // old name
}

TEST(Help, GroupsTheOptionsOfAShow) {
    for (const char* command : {"live", "play"}) {
        const ProgramResult help = run_to_end(VANTAGE_PROGRAM, {command, "--help"});
        ASSERT_EQ(help.status, 0) << help.err;
        for (const char* group :
             {"Input", "Camera", "Picture", "Output", "Control", "Recording", "3-D", "Expert"})
            EXPECT_NE(help.out.find(std::string("\n") + group + ":\n"), std::string::npos)
                << command << ": " << group << "\n"
                << help.out;
        for (const char* old_name :
             {"--save-set", "--set", "--novelty", "--no-harmonise"})  // old name
            EXPECT_EQ(help.out.find(old_name), std::string::npos) << old_name;
        const std::size_t general = help.out.find("\nOptions:\n");
        const std::size_t next = help.out.find("\n\n", general + 1);
        EXPECT_EQ(help.out.substr(general, next - general).find("--"),
                  help.out.substr(general, next - general).rfind("--"))
            << "only --help has no group";
    }
}

}  // namespace
}  // namespace vantage
