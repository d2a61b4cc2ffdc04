#include "rig_firmware/capture/material/numbered_files.h"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

TEST(NumberedFiles, WritesNumbersAsPrintfDoes) {
    EXPECT_EQ(NumberedFiles("a/left_%04d.png").path(7), "a/left_0007.png");
    EXPECT_EQ(NumberedFiles("a/left_%04d.png").path(12345), "a/left_12345.png");
    EXPECT_EQ(NumberedFiles("%d.jpg").path(0), "./0.jpg");
}

TEST(NumberedFiles, RefusesOtherPatterns) {
    for (const char* pattern :
         {"left.png", "%s.png", "%d_%d.png", "%4d.png", "%.png", "%%d.png", "take_%d/left.png"})
        EXPECT_THROW(NumberedFiles{pattern}, Error) << pattern;
}

TEST(NumberedFiles, TakesFoldersAndExistingFilesByTheirNames) {
    const TemporaryFolder temporary;
    const auto folder = temporary.path() / "rig 50%d";
    std::filesystem::create_directory(folder);
    EXPECT_FALSE(NumberedFiles::is_pattern(folder / "a.jpg"));
    EXPECT_TRUE(NumberedFiles::is_pattern(folder / "shot %d.jpg"));
    std::ofstream(folder / "shot 3.jpg") << "x";
    EXPECT_EQ(NumberedFiles(folder / "shot %d.jpg").count_from(3), 1);
    EXPECT_EQ(NumberedFiles(folder / "shot %d.jpg").path(3), folder / "shot 3.jpg");
    std::ofstream(folder / "shot %d.jpg") << "x";
    EXPECT_FALSE(NumberedFiles::is_pattern(folder / "shot %d.jpg"));
}

TEST(NumberedFiles, CountsWhatFollowsWithoutAGap) {
    const TemporaryFolder folder;
    const NumberedFiles files(folder.path() / "l%03d.png");
    const auto touch = [&](const char* name) { std::ofstream(folder.path() / name) << "x"; };
    EXPECT_NE(thrown_sentence([&] { files.count_from(0); }), "");
    for (const char* name : {"l002.png", "l003.png", "l004.png", "l0005.png", "l5.png", "r006.png",
                             "l007.jpg", "lx08.png"})
        touch(name);
    EXPECT_EQ(files.count_from(2), 3);
    EXPECT_EQ(files.count_from(3), 2);
    EXPECT_NE(thrown_sentence([&] { files.count_from(0); }).find("l000.png is missing"),
              std::string::npos);
    EXPECT_NE(thrown_sentence([&] { files.count_from(5); }), "");
    touch("l006.png");
    EXPECT_NE(thrown_sentence([&] { files.count_from(2); }).find("l005.png is missing"),
              std::string::npos);
    EXPECT_NE(thrown_sentence([&] { NumberedFiles("/nowhere/at/all/%d.png").count_from(0); }), "");
}

}  // namespace
}  // namespace vantage
