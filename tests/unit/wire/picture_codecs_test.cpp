#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "common/base/error.h"
#include "common/wire/colour_codec.h"
#include "common/wire/disparity_codec.h"
#include "tests/support/thrown_sentence.h"
#include "tests/support/wire_frames.h"

namespace vantage {
namespace {

class PictureCodecTest : public testing::TestWithParam<std::tuple<int, int>> {
  protected:
    int width() const { return std::get<0>(GetParam()); }
    int height() const { return std::get<1>(GetParam()); }
};

TEST_P(PictureCodecTest, NoiseOverAllOfDisparityIsBitExact) {
    DisparityImage disparity(height(), width());
    cv::randu(disparity, 0, 65536);
    disparity(0, 0) = 65535;
    disparity(height() - 1, width() - 1) = 0;
    const auto payload = DisparityEncoder().encode(disparity);
    EXPECT_TRUE(same_pixels(DisparityDecoder().decode(payload, width(), height()), disparity));
}

TEST_P(PictureCodecTest, NoiseInAllFourChannelsIsBitExactWithoutLoss) {
    ColourImage colour(height(), width());
    cv::randu(colour, cv::Scalar::all(0), cv::Scalar::all(256));
    const auto payload = LosslessColourEncoder().encode(colour);
    EXPECT_TRUE(same_pixels(LosslessColourDecoder().decode(payload, width(), height()), colour));
}

TEST_P(PictureCodecTest, JpegComesBackCloseAndOpaque) {
    const ColourImage colour(height(), width(), cv::Vec4b(200, 100, 50, 255));
    const auto payload = JpegEncoder().encode(colour, 90);
    const ColourImage back = JpegDecoder().decode(payload, width(), height());
    ASSERT_EQ(back.size(), colour.size());
    EXPECT_LE(cv::norm(back, colour, cv::NORM_INF), 3);
    EXPECT_EQ(back(height() / 2, width() / 2)[3], 255);
}

INSTANTIATE_TEST_SUITE_P(Sizes, PictureCodecTest,
                         testing::Values(std::tuple(1, 1), std::tuple(1, 7), std::tuple(7, 1),
                                         std::tuple(61, 47), std::tuple(311, 239)));

TEST(PictureCodecs, TakePicturesWithPaddedRows) {
    const RigFrame frame = make_frame(1);
    const cv::Rect part(3, 5, 31, 17);
    const DisparityImage disparity = frame.disparity(part);
    const ColourImage colour = frame.colour(part);
    EXPECT_TRUE(same_pixels(DisparityDecoder().decode(DisparityEncoder().encode(disparity), 31, 17),
                            disparity));
    EXPECT_TRUE(same_pixels(
        LosslessColourDecoder().decode(LosslessColourEncoder().encode(colour), 31, 17), colour));
    EXPECT_EQ(JpegDecoder().decode(JpegEncoder().encode(colour, 100), 31, 17).size(),
              colour.size());
}

TEST(PictureCodecs, SmoothDisparityShrinksManyTimes) {
    DisparityImage disparity(240, 320);
    for (int y = 0; y < disparity.rows; ++y)
        for (int x = 0; x < disparity.cols; ++x)
            disparity(y, x) = static_cast<std::uint16_t>(600 + y / 3 + x / 2);
    EXPECT_LT(DisparityEncoder().encode(disparity).size(), 2 * disparity.total() / 20);
}

TEST(PictureCodecs, EveryTruncationIsRefused) {
    const RigFrame frame = make_frame(1);
    const int width = frame.colour.cols;
    const int height = frame.colour.rows;
    const auto disparity = DisparityEncoder().encode(frame.disparity);
    const auto lossless = LosslessColourEncoder().encode(frame.colour);
    const auto jpeg = JpegEncoder().encode(frame.colour, 85);
    for (const double part : {0.0, 0.01, 0.1, 0.5, 0.9, 0.99}) {
        const auto cut = [&](const std::vector<std::byte>& payload) {
            return std::span(payload).first(
                static_cast<std::size_t>(part * static_cast<double>(payload.size())));
        };
        EXPECT_THROW(DisparityDecoder().decode(cut(disparity), width, height), Error);
        EXPECT_THROW(LosslessColourDecoder().decode(cut(lossless), width, height), Error);
        EXPECT_THROW(JpegDecoder().decode(cut(jpeg), width, height), Error);
    }
}

TEST(PictureCodecs, PicturesOfAnotherSizeAreRefused) {
    const RigFrame frame = make_frame(1);
    const int width = frame.colour.cols;
    const int height = frame.colour.rows;
    EXPECT_THROW(
        DisparityDecoder().decode(DisparityEncoder().encode(frame.disparity), width, height + 1),
        Error);
    EXPECT_THROW(LosslessColourDecoder().decode(LosslessColourEncoder().encode(frame.colour),
                                                width - 1, height),
                 Error);
    EXPECT_THROW(JpegDecoder().decode(JpegEncoder().encode(frame.colour, 85), height, width),
                 Error);
}

TEST(PictureCodecs, AClaimOfAnotherContentSizeIsRefusedBeforeMemoryIsTaken) {
    const std::vector<std::byte> small(100);
    const auto payload = PayloadCompressor().compress(small);
    const std::string sentence =
        thrown_sentence([&] { DisparityDecoder().decode(payload, 4096, 4096); });
    EXPECT_THAT(sentence, testing::HasSubstr("100 bytes"));
    EXPECT_THAT(sentence, testing::HasSubstr("33554432"));
}

}  // namespace
}  // namespace vantage
