#include "common/image/picture_list.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using testing::ElementsAre;

class PictureListTest : public testing::Test {
  protected:
    std::filesystem::path touch(const std::string& name) const {
        const std::filesystem::path file = folder_.path() / name;
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file) << "x";
        return file;
    }
    std::vector<std::filesystem::path> found(const std::string& name) const {
        return expand_pictures((folder_.path() / name).string());
    }
    TemporaryFolder folder_;
};

TEST_F(PictureListTest, AFileThatExistsIsTakenByItsName) {
    const auto bracket = touch("left[1].jpg"), star = touch("left*.jpg");
    touch("left1.jpg");
    EXPECT_THAT(found("left[1].jpg"), ElementsAre(bracket));
    EXPECT_THAT(found("left*.jpg"), ElementsAre(star));
}

TEST_F(PictureListTest, FoldersAreTakenByTheirNames) {
    for (const char* folder : {"rig [1]", "a\\b", "50%", "what?", "{a,b}"}) {
        const auto one = touch(std::string(folder) + "/left1.png");
        const auto ten = touch(std::string(folder) + "/left10.png");
        const auto two = touch(std::string(folder) + "/left2.png");
        touch(std::string(folder) + "/.hidden.png");
        touch(std::string(folder) + "/sub/left3.png");
        EXPECT_THAT(found(std::string(folder)), ElementsAre(one, two, ten)) << folder;
        EXPECT_THAT(found(std::string(folder) + "/left*.png"), ElementsAre(one, two, ten))
            << folder;
        EXPECT_THAT(found(std::string(folder) + "/left?.png"), ElementsAre(one, two)) << folder;
    }
}

TEST_F(PictureListTest, ANumberIsWrittenAsInTheSourceOfARig) {
    const auto two = touch("left_0002.png"), ten = touch("left_10.png");
    touch("left_x.png");
    touch("left_.png");
    touch("right_2.png");
    for (const char* name : {"left_%d.png", "left_%04d.png"})
        EXPECT_THAT(found(name), ElementsAre(two, ten)) << name;
    const auto percent = touch("left_%d.png");
    EXPECT_THAT(found("left_%d.png"), ElementsAre(percent)) << "a file of that very name";
    EXPECT_NE(thrown_sentence([&] { found("other%d.png"); }).find("no file matches"),
              std::string::npos);
}

TEST_F(PictureListTest, OnlyTheLastPartIsAPattern) {
    touch("rig1/left1.png");
    const auto bracketed = touch("rig[1]/left2.png");
    EXPECT_THAT(found("rig[1]/left*"), ElementsAre(bracketed));
    EXPECT_NE(thrown_sentence([&] { found("rig1/right*"); }).find("no file matches"),
              std::string::npos);
    EXPECT_NE(thrown_sentence([&] { found("rig1/left[1.png"); }).find("no file matches"),
              std::string::npos);
}

TEST(NaturalOrder, CountsNumbersWithinATextAsNumbers) {
    EXPECT_TRUE(is_naturally_before("img_2.jpg", "img_10.jpg"));
    EXPECT_FALSE(is_naturally_before("img_10.jpg", "img_2.jpg"));
    EXPECT_TRUE(is_naturally_before("A (1).jpg", "A (2).jpg"));
    EXPECT_TRUE(is_naturally_before("cam2/9.jpg", "cam10/1.jpg"));
    EXPECT_FALSE(is_naturally_before("a", "a"));
    EXPECT_NE(is_naturally_before("1.jpg", "01.jpg"), is_naturally_before("01.jpg", "1.jpg"));
}

}  // namespace
}  // namespace vantage
