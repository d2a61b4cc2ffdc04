#include "common/base/files/folder.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

TEST(MakeFolder, CreatesParentsAndKeepsAnExistingFolder) {
    const TemporaryFolder temp;
    make_folder(temp.path() / "a/b");
    std::ofstream(temp.path() / "a/b/kept") << "kept";
    make_folder(temp.path() / "a/b");
    EXPECT_TRUE(std::filesystem::exists(temp.path() / "a/b/kept"));
}

TEST(MakeFolder, NamesTheFolderAndTheMendIfAFileIsInTheWay) {
    const TemporaryFolder temp;
    std::ofstream(temp.path() / "file") << "x";
    EXPECT_THAT(thrown_sentence([&] { make_folder(temp.path() / "file/below"); }),
                testing::AllOf(testing::HasSubstr("file/below"),
                               testing::HasSubstr("give one that can be written")));
}

}  // namespace
}  // namespace vantage
