#include <filesystem>
#include <regex>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/child_program.h"

namespace vantage {
namespace {

/// Whoever has the packages has no hw_config: what documents a file is named as it is installed
/// too.
TEST(Help, NamesExamplesWherePackagesPutThem) {
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

}  // namespace
}  // namespace vantage
