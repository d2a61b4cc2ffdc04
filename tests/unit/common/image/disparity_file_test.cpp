#include "common/image/disparity_file.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/image/image_file.h"
#include "common/image/pfm.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

const DisparityImage example = (DisparityImage(1, 4) << 0, 1, 33, 65535);

TEST(DisparityFile, HoldsPixelsAndInfinityForUnknownAsPfm) {
    const TemporaryFolder folder;
    write_disparity(folder.path() / "d.pfm", example);
    const cv::Mat1f px = read_pfm(folder.path() / "d.pfm");
    EXPECT_TRUE(std::isinf(px(0, 0)) && px(0, 0) > 0);
    EXPECT_EQ(px(0, 1), 1.0f / 32);
    EXPECT_EQ(px(0, 2), 33.0f / 32);
    EXPECT_EQ(px(0, 3), 65535.0f / 32);
}

TEST(DisparityFile, HoldsTheCodesAsPng) {
    const TemporaryFolder folder;
    write_disparity(folder.path() / "d.png", example);
    EXPECT_EQ(cv::norm(read_code_image(folder.path() / "d.png"), example, cv::NORM_INF), 0);
}

TEST(DisparityFile, RefusesAnExtensionThatNamesNoForm) {
    const std::string sentence = thrown_sentence([] { disparity_form("out/d.jpg"); });
    EXPECT_NE(sentence.find("out/d.jpg"), std::string::npos) << sentence;
    EXPECT_NE(sentence.find(".pfm"), std::string::npos) << sentence;
}

}  // namespace
}  // namespace vantage
