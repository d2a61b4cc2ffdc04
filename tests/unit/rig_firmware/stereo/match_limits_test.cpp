#include <gtest/gtest.h>

#include "common/base/error.h"
#include "rig_firmware/stereo/matcher.h"

namespace vantage {
namespace {

std::string refusal(int width, int height, int disparities) {
    try {
        require_match_limits({width, height, disparities, MatchPreset::balanced, true});
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(MatchLimits, TakeTheLargestPictureAndRange) { EXPECT_EQ(refusal(4096, 4096, 256), ""); }

TEST(MatchLimits, NameTheLimitOfWhatTheyRefuse) {
    EXPECT_NE(refusal(4097, 100, 64).find("4096"), std::string::npos);
    EXPECT_NE(refusal(100, 4097, 64).find("4096"), std::string::npos);
    EXPECT_NE(refusal(640, 480, 257).find("256"), std::string::npos);
    EXPECT_NE(refusal(640, 480, 0).find("1 to 256"), std::string::npos);
    EXPECT_NE(refusal(15, 480, 16).find("16"), std::string::npos);
}

}  // namespace
}  // namespace vantage
