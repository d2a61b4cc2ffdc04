#include "common/base/files/output_path.h"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

class OutputPathTest : public testing::Test {
  protected:
    std::string refusal(const std::filesystem::path& output,
                        std::initializer_list<std::filesystem::path> others = {}) {
        return thrown_sentence([&] { require_writable_output(output, others); });
    }
    std::filesystem::path make_file(const char* name) {
        const std::filesystem::path path = folder_.path() / name;
        std::ofstream(path) << "x";
        return path;
    }
    TemporaryFolder folder_;
};

TEST_F(OutputPathTest, TakesANewFileAndAnOldOne) {
    EXPECT_EQ(refusal(folder_.path() / "new.png", {make_file("input.png")}), "");
    EXPECT_EQ(refusal(make_file("old.png")), "");
    EXPECT_EQ(refusal("new-in-the-current-folder.png"), "");
}

TEST_F(OutputPathTest, RefusesAnInputUnderAnyOfItsNames) {
    const std::filesystem::path input = make_file("input.png");
    std::filesystem::create_symlink(input, folder_.path() / "link.png");
    EXPECT_NE(refusal(input, {input}), "");
    EXPECT_NE(refusal(folder_.path() / "." / "input.png", {input}), "");
    EXPECT_NE(refusal(folder_.path() / "link.png", {input}), "");
}

TEST_F(OutputPathTest, RefusesTwoOutputsOfOneNameBeforeEitherIsThere) {
    EXPECT_NE(refusal(folder_.path() / "a.png", {folder_.path() / "." / "a.png"}), "");
}

TEST_F(OutputPathTest, RefusesAFolderAndAMissingFolder) {
    EXPECT_NE(refusal(folder_.path()).find("folder"), std::string::npos);
    EXPECT_NE(refusal(folder_.path() / "missing" / "a.png").find("missing/a.png"),
              std::string::npos);
}

}  // namespace
}  // namespace vantage
