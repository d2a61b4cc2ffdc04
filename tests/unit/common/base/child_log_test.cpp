#include "common/base/child_log.h"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/data_folder.h"

namespace vantage {
namespace {

TEST(ChildLog, GivesTheSentenceThatAProgramEndedWith) {
    const TemporaryFolder folder;
    const auto log = folder.path() / "rig.log";
    EXPECT_EQ(last_sentence_of(log), "");
    std::ofstream(log) << "12:00:00.000 vantage-rig: starting\n"
                       << "vantage-rig: error: the baseline of 0.2 mm is too short\n\n";
    EXPECT_EQ(last_sentence_of(log), "the baseline of 0.2 mm is too short");
    EXPECT_TRUE(warnings_in(log).empty());
    std::ofstream(log) << "12:00:00.000 vantage-rig: warning: it lies on its side\nmore\n";
    EXPECT_EQ(warnings_in(log), std::vector<std::string>{"it lies on its side"});
    std::ofstream(log) << std::string(200'000, 'x') << "\nkilled";
    EXPECT_EQ(last_sentence_of(log), "killed");
}

}  // namespace
}  // namespace vantage
