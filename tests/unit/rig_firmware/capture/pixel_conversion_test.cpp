#include "rig_firmware/capture/pixel_conversion.h"

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/image/jpeg.h"

namespace vantage {
namespace {

std::vector<std::byte> bytes(std::initializer_list<int> values) {
    std::vector<std::byte> result;
    for (const int value : values) result.push_back(static_cast<std::byte>(value));
    return result;
}

/// The nearest that 8 bits hold of what BT.601 of limited range says.
cv::Vec3d rgb(double y, double u, double v) {
    const double luma = 1.164 * (y - 16);
    return {luma + 1.596 * (v - 128), luma - 0.392 * (u - 128) - 0.813 * (v - 128),
            luma + 2.017 * (u - 128)};
}

void expect_near(const cv::Vec4b& pixel, const cv::Vec3d& wanted) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(pixel[i], std::clamp(wanted[i], 0.0, 255.0), 1.5) << "channel " << i;
    EXPECT_EQ(pixel[3], 255);
}

TEST(PixelFormat, IsNamedByFourCharacters) {
    for (const PixelFormat format : known_pixel_formats())
        EXPECT_EQ(parse_pixel_format(fourcc_text(fourcc_of(format))), format);
    EXPECT_EQ(parse_pixel_format("Y16 "), PixelFormat::y16);
    EXPECT_THROW(parse_pixel_format("Y16"), Error);
    EXPECT_THROW(parse_pixel_format("RGB3"), Error);
}

TEST(PixelFormat, GreyKeepsItsValuesAndLeavesOutPadding) {
    const auto data = bytes({1, 2, 3, 99, 4, 5, 255});
    const ColourImage colour = to_colour({PixelFormat::grey, 3, 2, 4, data});
    EXPECT_EQ(colour.size(), cv::Size(3, 2));
    EXPECT_EQ(colour(0, 2), cv::Vec4b(3, 3, 3, 255));
    EXPECT_EQ(colour(1, 0), cv::Vec4b(4, 4, 4, 255));
    EXPECT_EQ(colour(1, 2), cv::Vec4b(255, 255, 255, 255));
}

TEST(PixelFormat, DeepGreyKeepsItsUpperEightBits) {
    const auto ten = bytes({0xff, 0x03, 0x04, 0x00, 0x03, 0x00, 0xff, 0xff});
    const ColourImage ten_bits = to_colour({PixelFormat::y10, 4, 1, 0, ten});
    EXPECT_EQ(ten_bits(0, 0)[0], 255);
    EXPECT_EQ(ten_bits(0, 1)[0], 1);
    EXPECT_EQ(ten_bits(0, 2)[0], 0);
    EXPECT_EQ(ten_bits(0, 3)[0], 255) << "bits above the ten are no reason to wrap";
    const auto sixteen = bytes({0xff, 0xff, 0xff, 0x00, 0x34, 0x12});
    const ColourImage sixteen_bits = to_colour({PixelFormat::y16, 3, 1, 0, sixteen});
    EXPECT_EQ(sixteen_bits(0, 0)[1], 255);
    EXPECT_EQ(sixteen_bits(0, 1)[1], 0);
    EXPECT_EQ(sixteen_bits(0, 2)[2], 0x12);
}

TEST(PixelFormat, YuyvIsConvertedPixelByPixel) {
    const auto data = bytes({60, 90, 200, 180, 120, 128, 16, 128});
    const ColourImage colour = to_colour({PixelFormat::yuyv, 4, 1, 0, data});
    expect_near(colour(0, 0), rgb(60, 90, 180));
    expect_near(colour(0, 1), rgb(200, 90, 180));
    expect_near(colour(0, 2), rgb(120, 128, 128));
    expect_near(colour(0, 3), rgb(16, 128, 128));
}

TEST(PixelFormat, Nv12SharesItsColourAmongFourPixels) {
    const auto data = bytes({50, 60, 0, 70, 80, 0, 100, 160, 0});
    const ColourImage colour = to_colour({PixelFormat::nv12, 2, 2, 3, data});
    expect_near(colour(0, 0), rgb(50, 100, 160));
    expect_near(colour(0, 1), rgb(60, 100, 160));
    expect_near(colour(1, 0), rgb(70, 100, 160));
    expect_near(colour(1, 1), rgb(80, 100, 160));
}

TEST(PixelFormat, MjpgIsDecodedInRedGreenBlueOrder) {
    const std::vector<std::byte> jpeg = encode_jpeg(cv::Mat3b(16, 16, cv::Vec3b(255, 128, 0)));
    const ColourImage colour = to_colour({PixelFormat::mjpg, 16, 16, 0, jpeg});
    EXPECT_NEAR(colour(8, 8)[0], 255, 4);
    EXPECT_NEAR(colour(8, 8)[1], 128, 4);
    EXPECT_NEAR(colour(8, 8)[2], 0, 4);
    EXPECT_THROW(to_colour({PixelFormat::mjpg, 16, 8, 0, jpeg}), Error);
    EXPECT_THROW(to_colour({PixelFormat::mjpg, 16, 16, 0, std::span(jpeg).first(40)}), Error);
}

TEST(PixelFormat, MjpgOfOrdinaryCamerasIsTaken) {
    std::vector<std::byte> padded = encode_jpeg(cv::Mat3b(16, 16, cv::Vec3b(255, 128, 0)));
    const ColourImage clean = to_colour({PixelFormat::mjpg, 16, 16, 0, padded});
    padded.insert(padded.end() - 2, 24, std::byte{0});
    EXPECT_EQ(cv::norm(to_colour({PixelFormat::mjpg, 16, 16, 0, padded}), clean, cv::NORM_INF), 0);
    const std::vector<std::byte> grey =
        encode_jpeg(cv::Mat1b(16, 16, static_cast<unsigned char>(77)));
    EXPECT_EQ(to_colour({PixelFormat::mjpg, 16, 16, 0, grey})(3, 4), cv::Vec4b(77, 77, 77, 255));
}

TEST(PixelFormat, RefusesTooFewBytesAndOddSides) {
    const std::vector<std::byte> data(64);
    const auto part = [&](std::size_t n) { return std::span(data).first(n); };
    EXPECT_NO_THROW(to_colour({PixelFormat::yuyv, 4, 2, 0, part(16)}));
    EXPECT_THROW(to_colour({PixelFormat::yuyv, 4, 2, 0, part(15)}), Error);
    EXPECT_THROW(to_colour({PixelFormat::yuyv, 4, 2, 4, part(64)}), Error) << "lines too short";
    EXPECT_THROW(to_colour({PixelFormat::yuyv, 3, 2, 0, part(64)}), Error);
    EXPECT_NO_THROW(to_colour({PixelFormat::nv12, 4, 2, 0, part(12)}));
    EXPECT_THROW(to_colour({PixelFormat::nv12, 4, 2, 0, part(11)}), Error);
    EXPECT_THROW(to_colour({PixelFormat::nv12, 4, 3, 0, part(64)}), Error);
    EXPECT_THROW(to_colour({PixelFormat::grey, 0, 2, 0, part(64)}), Error);
    EXPECT_THROW(to_colour({PixelFormat::mjpg, 4, 2, 0, part(0)}), Error);
}

}  // namespace
}  // namespace vantage
