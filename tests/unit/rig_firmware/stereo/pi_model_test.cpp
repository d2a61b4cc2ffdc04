#include "rig_firmware/stereo/pi_model.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

TEST(PiModel, ChargesEachPassTheLongerOfTrafficAndArithmetic) {
    const PiModel model{"a model", 1e9, 2e9};
    const std::vector<PassReport> passes = {
        {.name = "moves", .bytes_moved = 5'000'000, .operations = 1e6},
        {.name = "computes", .bytes_moved = 1'000'000, .operations = 8e6}};
    EXPECT_DOUBLE_EQ(modelled_frame_ms(model, passes), 5.0 + 4.0);
}

TEST(PiModel, NamesBothPisAndSaysThatItIsAModel) {
    const std::string lines = pi_model_lines({{.name = "moves", .bytes_moved = 4'800'000}});
    EXPECT_NE(lines.find("Raspberry Pi 4: a frame takes 1.9 ms"), std::string::npos) << lines;
    EXPECT_NE(lines.find("Raspberry Pi 5: a frame takes 1.2 ms"), std::string::npos) << lines;
    EXPECT_NE(lines.find("model"), std::string::npos);
}

}  // namespace
}  // namespace vantage
