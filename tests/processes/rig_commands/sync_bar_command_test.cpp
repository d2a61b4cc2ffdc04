#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/child_program.h"

namespace vantage {
namespace {

TEST(SyncBarCommand, counts_without_lines_and_says_how_late_it_was) {
    const ProgramResult result =
        run_to_end(VANTAGE_RIG, {"sync-bar", "--pretended", "--step-us", "1000", "--seconds", "0.2",
                                 "--priority", "0", "--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_GT(json.at("shown").get<int>(), 10);
    EXPECT_EQ(json.at("lateness_us").at("count"), json.at("shown"));
}

TEST(SyncBarCommand, says_what_of_its_lines_does_not_fit) {
    EXPECT_NE(run_to_end(VANTAGE_RIG, {"sync-bar"}).err.find("give --chip"), std::string::npos);
    EXPECT_NE(run_to_end(VANTAGE_RIG, {"sync-bar", "--chip", "x", "--lines", "GPIO1,GPIO2"})
                  .err.find("12 LEDs need as many lines, and --lines names 2"),
              std::string::npos);
    EXPECT_NE(run_to_end(VANTAGE_RIG, {"sync-bar", "--chip", "x", "--leds", "13"})
                  .err.find("13 LEDs need 13 lines, and 12 are known"),
              std::string::npos);
}

}  // namespace
}  // namespace vantage
