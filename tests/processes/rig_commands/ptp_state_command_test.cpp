#include <csignal>
#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/eventually.h"

namespace vantage {
namespace {

TEST(PtpStateCommand, WritesALineOfJsonWhereNoPtp4lAnswersAndNoFileUnasked) {
    const TemporaryFolder folder;
    ChildProgram program(VANTAGE_RIG,
                         {"ptp-state", "--json", "--ptp4l", (folder.path() / "none").string()},
                         folder.path());
    EXPECT_TRUE(eventually([&] { return program.out().find('\n') != std::string::npos; }));
    program.send_signal(SIGINT);
    const ProgramResult result = program.wait();
    EXPECT_EQ(result.status, 130) << result.err;
    const std::string line = result.out.substr(0, result.out.find('\n'));
    const nlohmann::json json = nlohmann::json::parse(line);
    EXPECT_TRUE(json.at("port_state").is_null()) << line;
    EXPECT_GT(json.at("monotonic_ns"), 0) << line;
}

}  // namespace
}  // namespace vantage
