#include <limits>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "common/base/error.h"
#include "common/wire/codec/colour_codec.h"
#include "common/wire/codec/disparity_codec.h"
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

TEST_P(PictureCodecTest, JpegOfAnyChromaComesBackCloseAndOpaque) {
    const ColourImage colour(height(), width(), cv::Vec4b(200, 100, 50, 255));
    for (const Chroma chroma : {Chroma::full, Chroma::half, Chroma::quarter}) {
        const auto payload = JpegEncoder().encode(colour, 90, chroma);
        EXPECT_EQ(JpegDecoder().chroma_of(payload), chroma);
        const ColourImage back = JpegDecoder().decode(payload, width(), height());
        ASSERT_EQ(back.size(), colour.size());
        EXPECT_LE(cv::norm(back, colour, cv::NORM_INF), 3) << name_of(chroma);
        EXPECT_EQ(back(height() / 2, width() / 2)[3], 255);
    }
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
    EXPECT_EQ(
        JpegDecoder().decode(JpegEncoder().encode(colour, 100, Chroma::quarter), 31, 17).size(),
        colour.size());
}

TEST(PictureCodecs, CoarserChromaIsSmallerAndLeavesBrightnessAlone) {
    // Stripes of red and blue that are as bright as each other.
    ColourImage stripes(64, 64);
    for (int y = 0; y < stripes.rows; ++y)
        for (int x = 0; x < stripes.cols; ++x)
            stripes(y, x) = x % 2 == 0 ? cv::Vec4b(200, 60, 60, 255) : cv::Vec4b(60, 108, 187, 255);
    std::size_t bytes = std::numeric_limits<std::size_t>::max();
    for (const Chroma chroma : {Chroma::full, Chroma::half, Chroma::quarter}) {
        const auto payload = JpegEncoder().encode(stripes, 95, chroma);
        EXPECT_LT(payload.size(), bytes) << name_of(chroma);
        bytes = payload.size();
        cv::Mat1b sent, came;
        cv::cvtColor(stripes, sent, cv::COLOR_RGBA2GRAY);
        cv::cvtColor(JpegDecoder().decode(payload, 64, 64), came, cv::COLOR_RGBA2GRAY);
        EXPECT_LE(cv::norm(sent, came, cv::NORM_INF), 6) << name_of(chroma);
    }
}

TEST(PictureCodecs, ParsesChromaByName) {
    for (const Chroma chroma : {Chroma::full, Chroma::half, Chroma::quarter})
        EXPECT_EQ(parse_chroma(name_of(chroma)), chroma);
    EXPECT_EQ(thrown_sentence([] { parse_chroma("4:1:1"); }),
              "chroma '4:1:1' is not one of 4:4:4, 4:2:2 and 4:2:0");
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
    const auto jpeg = JpegEncoder().encode(frame.colour, 85, Chroma::quarter);
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

TEST(PictureCodecs, OneDecoderTakesWholeJpegsAfterAnyDamagedOne) {
    const RigFrame frame = make_frame(1);
    const auto jpeg = JpegEncoder().encode(frame.colour, 85, Chroma::quarter);
    const ColourImage whole = JpegDecoder().decode(jpeg, frame.colour.cols, frame.colour.rows);
    JpegDecoder decoder;
    for (std::size_t size = 0; size < jpeg.size(); size += 7) {
        const std::span<const std::byte> cut(jpeg.data(), size);
        EXPECT_THROW(decoder.decode(cut, frame.colour.cols, frame.colour.rows), Error) << size;
        ASSERT_TRUE(same_pixels(decoder.decode(jpeg, frame.colour.cols, frame.colour.rows), whole))
            << size;
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
    EXPECT_THROW(JpegDecoder().decode(JpegEncoder().encode(frame.colour, 85, Chroma::quarter),
                                      height, width),
                 Error);
}

TEST(PictureCodecs, RefusesAWrongContentSizeBeforeAllocating) {
    const std::vector<std::byte> small(100);
    const auto payload = PayloadCompressor().compress(small);
    const std::string sentence =
        thrown_sentence([&] { DisparityDecoder().decode(payload, 4096, 4096); });
    EXPECT_THAT(sentence, testing::HasSubstr("100 bytes"));
    EXPECT_THAT(sentence, testing::HasSubstr("33554432"));
}

}  // namespace
}  // namespace vantage
