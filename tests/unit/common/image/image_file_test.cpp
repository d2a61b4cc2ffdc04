#include "common/image/image_file.h"

#include <cstring>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "common/base/files/atomic_file.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

ColourImage some_picture(int width, int height) {
    ColourImage image(height, width);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            image(y, x) =
                cv::Vec4b(static_cast<unsigned char>(3 * x), static_cast<unsigned char>(5 * y),
                          static_cast<unsigned char>(x * y), 255);
    return image;
}

class ImageFileTest : public testing::Test {
  protected:
    std::filesystem::path path(const char* name) const { return folder_.path() / name; }
    void write_bytes(const std::filesystem::path& to, std::span<const std::byte> bytes) const {
        write_file_atomically(to, bytes);
    }
    TemporaryFolder folder_;
};

TEST_F(ImageFileTest, PngKeepsEveryPixelInRgbaOrder) {
    const ColourImage image = some_picture(31, 23);
    write_colour_image(path("a.png"), image);
    EXPECT_EQ(cv::norm(read_colour_image(path("a.png")), image, cv::NORM_INF), 0);
    const cv::Mat bgr = cv::imread(path("a.png").string());
    EXPECT_EQ(bgr.at<cv::Vec3b>(0, 30)[2], 90) << "red is red for others too";
}

TEST_F(ImageFileTest, JpegComesCloseToTheOriginal) {
    ColourImage smooth(48, 64);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x)
            smooth(y, x) = cv::Vec4b(static_cast<unsigned char>(2 * x),
                                     static_cast<unsigned char>(3 * y), 100, 255);
    write_colour_image(path("a.jpg"), smooth);
    EXPECT_LT(cv::norm(read_colour_image(path("a.jpg")), smooth, cv::NORM_INF), 16);
}

// What another program wrote.
TEST_F(ImageFileTest, ReadsWhatOpenCvWrites) {
    const ColourImage image = some_picture(37, 21);
    cv::Mat bgr, bgra, wide, grey;
    cv::cvtColor(image, bgr, cv::COLOR_RGBA2BGR);
    cv::cvtColor(image, bgra, cv::COLOR_RGBA2BGRA);
    bgra.forEach<cv::Vec4b>([](cv::Vec4b& pixel, const int*) { pixel[3] = 100; });
    bgr.convertTo(wide, CV_16U, 257);
    cv::extractChannel(bgr, grey, 1);
    const auto difference = [&](const char* name, const cv::Mat& written) {
        EXPECT_TRUE(cv::imwrite(path(name).string(), written));
        EXPECT_TRUE(is_picture_file(path(name))) << name;
        return cv::norm(read_colour_image(path(name)), image, cv::NORM_INF);
    };
    EXPECT_EQ(difference("rgb.png", bgr), 0);
    EXPECT_EQ(difference("rgba.png", bgra), 0) << "alpha is left out";
    EXPECT_EQ(difference("wide.png", wide), 0);
    EXPECT_EQ(difference("rgb.ppm", bgr), 0);
    EXPECT_EQ(difference("wide.ppm", wide), 0);
    ASSERT_TRUE(cv::imwrite(path("rgb.jpg").string(), bgr));
    const cv::Mat jpeg = cv::imread(path("rgb.jpg").string());
    ColourImage same;
    cv::cvtColor(jpeg, same, cv::COLOR_BGR2RGBA);
    EXPECT_LE(cv::norm(read_colour_image(path("rgb.jpg")), same, cv::NORM_INF), 2);
    ASSERT_TRUE(cv::imwrite(path("grey.jpg").string(), grey));
    EXPECT_LT(cv::norm(to_grey(read_colour_image(path("grey.jpg"))), grey, cv::NORM_INF), 40);
    cv::Mat1w codes(5, 7);
    cv::randu(codes, 0, 65536);
    for (const char* name : {"codes.png", "codes.pgm"}) {
        ASSERT_TRUE(cv::imwrite(path(name).string(), codes));
        EXPECT_EQ(cv::norm(read_code_image(path(name)), codes, cv::NORM_INF), 0) << name;
    }
    EXPECT_FALSE(is_picture_file(path("none.png")));
}

TEST_F(ImageFileTest, BelievesNoPngThatIsTooSmallForItsSize) {
    write_grey_image(path("a.png"), cv::Mat1b(cv::Mat1b::zeros(200, 200)));
    std::vector<std::byte> bytes = read_file(path("a.png"), 1 << 20);
    // Width and height, 16384 each, and the checksum that goes with them.
    const std::string head("\0\0\x40\0\0\0\x40\0\x8\0\0\0\0\x8c\xa3\x4f\x58", 17);
    std::memcpy(bytes.data() + 16, head.data(), head.size());
    write_bytes(path("a.png"), bytes);
    EXPECT_NE(thrown_sentence([&] { read_colour_image(path("a.png")); }).find("too few for 16384"),
              std::string::npos);
}

TEST_F(ImageFileTest, NamesWhatIsWrongWithAPgm) {
    const auto refusal = [&](const std::string& text) {
        write_bytes(path("a.pgm"), std::as_bytes(std::span(text)));
        return thrown_sentence([&] { read_code_image(path("a.pgm")); });
    };
    EXPECT_EQ(refusal("P5 # a comment\n2 1\n# another\n255\nab"), "");
    EXPECT_NE(refusal("P5 2 2 255\nab").find("2 of its 4 bytes are missing"), std::string::npos);
    EXPECT_NE(refusal("P5 2 1 1023\nabcd").find("1023"), std::string::npos);
    EXPECT_NE(refusal("P5 2 99999 255\nab").find("16384"), std::string::npos);
    for (const char* damaged :
         {"P5", "P5 2", "P5 -2 1 255\nab", "P5 2 1 255", "P5 2 1 255ab", "P5#"})
        EXPECT_NE(refusal(damaged).find("header"), std::string::npos) << damaged;
}

TEST_F(ImageFileTest, GreyFilesBecomeColour) {
    const cv::Mat1b grey(4, 6, static_cast<unsigned char>(77));
    write_grey_image(path("g.png"), grey);
    EXPECT_EQ(read_colour_image(path("g.png"))(3, 5), cv::Vec4b(77, 77, 77, 255));
}

TEST_F(ImageFileTest, CodesComeBackUnscaled) {
    cv::Mat1w codes(2, 3);
    codes << 0, 1, 255, 256, 40000, 65535;
    write_grey_image(path("c.png"), codes);
    EXPECT_EQ(cv::norm(read_code_image(path("c.png")), codes, cv::NORM_INF), 0);
    const cv::Mat1b small(1, 2, static_cast<unsigned char>(200));
    write_grey_image(path("s.png"), small);
    EXPECT_EQ(read_code_image(path("s.png"))(0, 1), 200) << "8-bit codes are not stretched";
    write_colour_image(path("grey_as_colour.png"), ColourImage(2, 2, cv::Vec4b(9, 9, 9, 255)));
    EXPECT_EQ(read_code_image(path("grey_as_colour.png"))(1, 1), 9);
}

TEST_F(ImageFileTest, RefusesColoursAsCodes) {
    write_colour_image(path("a.png"), some_picture(8, 8));
    EXPECT_NE(thrown_sentence([&] { read_code_image(path("a.png")); }).find("colour picture"),
              std::string::npos);
}

TEST_F(ImageFileTest, NamesTheFileThatIsMissingOrNoPicture) {
    EXPECT_NE(thrown_sentence([&] {
                  read_colour_image(path("missing.png"));
              }).find(path("missing.png").string() + ": No such file"),
              std::string::npos);
    const std::string text = "this is not a picture";
    write_bytes(path("text.png"), std::as_bytes(std::span(text)));
    EXPECT_NE(thrown_sentence([&] { read_colour_image(path("text.png")); }).find("not a picture"),
              std::string::npos);
    write_bytes(path("empty.png"), {});
    EXPECT_NE(thrown_sentence([&] { read_colour_image(path("empty.png")); }).find("not a picture"),
              std::string::npos);
    EXPECT_NE(thrown_sentence([&] { read_colour_image(folder_.path()); }).find("is a folder"),
              std::string::npos);
}

TEST_F(ImageFileTest, RefusesPicturesCutShort) {
    for (const char* name : {"a.png", "a.jpg"}) {
        write_colour_image(path(name), some_picture(200, 150));
        const auto whole = read_file(path(name), 1 << 20);
        for (const double share : {0.3, 0.6, 0.95}) {
            const auto length = static_cast<std::size_t>(share * static_cast<double>(whole.size()));
            write_bytes(path(name), std::span(whole).first(length));
            EXPECT_NE(thrown_sentence([&] { read_colour_image(path(name)); }).find("damaged"),
                      std::string::npos)
                << name << " cut to " << share;
        }
    }
}

TEST_F(ImageFileTest, RefusesPicturesTooLargeForAnyPart) {
    write_grey_image(path("wide.png"), cv::Mat1b::zeros(1, max_image_side_px + 1));
    EXPECT_NE(thrown_sentence([&] { read_colour_image(path("wide.png")); }).find("16384"),
              std::string::npos);
    write_grey_image(path("widest.png"), cv::Mat1b::zeros(1, max_image_side_px));
    EXPECT_EQ(read_colour_image(path("widest.png")).cols, max_image_side_px);
}

TEST_F(ImageFileTest, RefusesExtensionsOfNoPictureAndKeepsTheOldFile) {
    const std::string old = "old";
    write_bytes(path("a.txt"), std::as_bytes(std::span(old)));
    EXPECT_NE(thrown_sentence([&] {
                  write_colour_image(path("a.txt"), some_picture(4, 4));
              }).find("'.txt'; use .png or .jpg"),
              std::string::npos);
    EXPECT_EQ(read_file(path("a.txt"), 10).size(), 3u);
    EXPECT_NE(thrown_sentence([&] { write_colour_image(path("none"), some_picture(4, 4)); }), "");
}

TEST(ToGrey, WeighsAsBt601AndRoundsToTheNearest) {
    const auto grey = [](int r, int g, int b) {
        return to_grey(
            ColourImage(1, 1,
                        cv::Vec4b(static_cast<unsigned char>(r), static_cast<unsigned char>(g),
                                  static_cast<unsigned char>(b), 255)))(0, 0);
    };
    EXPECT_EQ(grey(255, 255, 255), 255);
    EXPECT_EQ(grey(0, 0, 0), 0);
    for (int v = 0; v < 256; v += 15) EXPECT_EQ(grey(v, v, v), v) << "grey stays as it is";
    for (int r = 0; r < 256; r += 51)
        for (int g = 0; g < 256; g += 51)
            for (int b = 0; b < 256; b += 51)
                EXPECT_NEAR(grey(r, g, b), 0.299 * r + 0.587 * g + 0.114 * b, 1.2);
}

}  // namespace
}  // namespace vantage
