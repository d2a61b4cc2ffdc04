#include "common/image/image_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "common/base/files/atomic_file.h"
#include "common/base/log.h"
#include "common/image/exif_orientation.h"
#include "common/image/jpeg.h"
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

// JPEGs as ordinary cameras write them ----------------------------------------------------------

using Bytes = std::vector<std::byte>;

Bytes jpeg_of(const cv::Mat& picture, const std::vector<int>& parameters) {
    std::vector<unsigned char> code;
    cv::imencode(".jpg", picture, code, parameters);
    const auto bytes = std::as_bytes(std::span(code));
    return {bytes.begin(), bytes.end()};
}

cv::Mat bgr_of(const ColourImage& picture) {
    cv::Mat bgr;
    cv::cvtColor(picture, bgr, cv::COLOR_RGBA2BGR);
    return bgr;
}

/// The place of the first marker from `from` on for which `is_wanted(code)` holds.
std::size_t marker_at(const Bytes& bytes, std::size_t from, auto is_wanted) {
    for (std::size_t i = from; i + 1 < bytes.size(); ++i)
        if (bytes[i] == std::byte{0xff} && is_wanted(std::to_integer<int>(bytes[i + 1]))) return i;
    ADD_FAILURE() << "no such marker";
    return 0;
}

Bytes with_zeros_at(Bytes bytes, std::size_t at, std::size_t count) {
    bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), count, std::byte{0});
    return bytes;
}

class CameraJpegTest : public ImageFileTest {
  protected:
    const cv::Mat bgr_ = bgr_of(some_picture(64, 48));
    const std::vector<int> restarts_{cv::IMWRITE_JPEG_RST_INTERVAL, 2};
};

TEST_F(CameraJpegTest, ZerosBeforeAMarkerCostNoPixel) {
    const Bytes clean = jpeg_of(bgr_, restarts_);
    const DecodedJpeg original = decode_jpeg(clean);
    EXPECT_EQ(original.oddity, "");
    const std::size_t restart =
        marker_at(clean, 0, [](int code) { return code >= 0xd0 && code <= 0xd7; });
    for (const Bytes& odd :
         {with_zeros_at(clean, clean.size() - 2, 24), with_zeros_at(clean, restart, 7)}) {
        const DecodedJpeg decoded = decode_jpeg(odd);
        EXPECT_EQ(cv::norm(decoded.image, original.image, cv::NORM_INF), 0);
        EXPECT_NE(decoded.oddity.find("extraneous bytes"), std::string::npos) << decoded.oddity;
        write_bytes(path("odd.jpg"), odd);
        EXPECT_EQ(thrown_sentence([&] { read_colour_image(path("odd.jpg")); }), "");
    }
}

TEST_F(CameraJpegTest, AMissingEndMarkerCostsNoPixel) {
    for (const int progressive : {0, 1}) {
        Bytes bytes = jpeg_of(bgr_, {cv::IMWRITE_JPEG_PROGRESSIVE, progressive});
        const DecodedJpeg original = decode_jpeg(bytes);
        bytes.resize(bytes.size() - 2);
        const DecodedJpeg decoded = decode_jpeg(bytes);
        EXPECT_EQ(cv::norm(decoded.image, original.image, cv::NORM_INF), 0);
        EXPECT_NE(decoded.oddity, "");
    }
}

TEST_F(CameraJpegTest, MissingScansAndPixelsAreRefused) {
    const Bytes progressive = jpeg_of(bgr_, {cv::IMWRITE_JPEG_PROGRESSIVE, 1});
    std::size_t last_scan = 0;
    for (std::size_t i = 0; i + 1 < progressive.size(); ++i)
        if (progressive[i] == std::byte{0xff} && progressive[i + 1] == std::byte{0xda})
            last_scan = i;
    EXPECT_NE(thrown_sentence([&] {
                  decode_jpeg(std::span(progressive).first(last_scan));
              }).find("cut off"),
              std::string::npos);
    const Bytes plain = jpeg_of(bgr_, {});
    EXPECT_NE(thrown_sentence([&] {
                  decode_jpeg(std::span(plain).first(plain.size() - 40));
              }).find("cut off"),
              std::string::npos);
    // Two of the parts between restart markers are gone.
    Bytes short_of_rows = jpeg_of(bgr_, restarts_);
    const std::size_t first = marker_at(short_of_rows, 0, [](int code) { return code == 0xd0; });
    const std::size_t third =
        marker_at(short_of_rows, first + 2, [](int code) { return code == 0xd2; });
    short_of_rows.erase(short_of_rows.begin() + static_cast<std::ptrdiff_t>(first),
                        short_of_rows.begin() + static_cast<std::ptrdiff_t>(third));
    EXPECT_NE(thrown_sentence([&] { decode_jpeg(short_of_rows); }), "");
}

TEST_F(CameraJpegTest, GreyBecomesColourWhereColourIsWanted) {
    const Bytes grey = jpeg_of(cv::Mat1b(16, 16, static_cast<unsigned char>(90)), {});
    EXPECT_EQ(decode_jpeg(grey).image.type(), CV_8UC1);
    const cv::Mat4b colour = decode_jpeg(grey, JpegChannels::rgba).image;
    EXPECT_EQ(colour(7, 7), cv::Vec4b(90, 90, 90, 255));
}

/// EXIF data with one entry, the orientation, in either byte order.
std::string exif_with(int orientation, bool is_little) {
    const auto number = [&](unsigned value, int bytes) {
        std::string text;
        for (int i = 0; i < bytes; ++i)
            text += static_cast<char>(value >> (8 * (is_little ? i : bytes - 1 - i)) & 0xff);
        return text;
    };
    return std::string(is_little ? "II" : "MM") + number(42, 2) + number(8, 4) + number(1, 2) +
           number(0x112, 2) + number(3, 2) + number(1, 4) +
           number(static_cast<unsigned>(orientation), 2) + number(0, 2) + number(0, 4);
}

TEST_F(CameraJpegTest, ToldOrientationsAreReadAndNotApplied) {
    const Bytes clean = jpeg_of(bgr_, {});
    const cv::Mat stored = decode_jpeg(clean).image;
    for (const bool is_little : {false, true})
        for (const int orientation : {1, 3, 6, 8}) {
            const std::string exif = std::string("Exif\0\0", 6) + exif_with(orientation, is_little);
            const std::size_t size = exif.size() + 2;
            const std::string segment = std::string("\xff\xe1") + static_cast<char>(size >> 8) +
                                        static_cast<char>(size) + exif;
            Bytes bytes = clean;
            const auto text = std::as_bytes(std::span(segment));
            bytes.insert(bytes.begin() + 2, text.begin(), text.end());
            const DecodedJpeg decoded = decode_jpeg(bytes);
            EXPECT_EQ(decoded.orientation, orientation);
            EXPECT_EQ(cv::norm(decoded.image, stored, cv::NORM_INF), 0);
            write_bytes(path("turned.jpg"), bytes);
            (void)read_colour_image(path("turned.jpg"));
        }
    const auto lines = recent_log_lines();
    const auto says = [&](const char* words) {
        return std::count_if(lines.begin(), lines.end(), [&](const std::string& line) {
            return line.find(words) != std::string::npos;
        });
    };
    EXPECT_EQ(says("shows it turned by 90 degrees clockwise") +
                  says("show it turned by 90 degrees clockwise"),
              1)
        << "once, not for each of the two files";
    EXPECT_EQ(says("upright"), 3);
}

TEST(ExifOrientation, IsUprightInDamagedData) {
    const std::string whole = exif_with(6, true);
    EXPECT_EQ(exif_orientation(std::as_bytes(std::span(whole))), 6);
    for (std::size_t length = 0; length < 20; ++length)
        EXPECT_EQ(exif_orientation(std::as_bytes(std::span(whole)).first(length)), 1) << length;
    const std::string out_of_range = exif_with(9, true);
    EXPECT_EQ(exif_orientation(std::as_bytes(std::span(out_of_range))), 1);
}

// Plain and deep pictures ------------------------------------------------------------------------

TEST_F(ImageFileTest, ReadsTheWholeNetpbmFamily) {
    const auto read = [&](const std::string& text) {
        write_bytes(path("a.pnm"), std::as_bytes(std::span(text)));
        EXPECT_TRUE(is_picture_file(path("a.pnm")));
        return read_colour_image(path("a.pnm"));
    };
    EXPECT_EQ(read("P2\n# made by hand\n2 1\n255\n7 # seven\n 200\n")(0, 1),
              cv::Vec4b(200, 200, 200, 255));
    EXPECT_EQ(read("P3 1 1 255 1 2 3")(0, 0), cv::Vec4b(1, 2, 3, 255));
    EXPECT_EQ(read("P1\n2 1\n01\n")(0, 0), cv::Vec4b(255, 255, 255, 255));
    EXPECT_EQ(read("P1\n2 1\n01\n")(0, 1), cv::Vec4b(0, 0, 0, 255));
    EXPECT_EQ(read("P4 9 1\n\x80\x80")(0, 0)[0], 0);
    EXPECT_EQ(read("P4 9 1\n\x80\x80")(0, 8)[0], 0);
    EXPECT_EQ(read("P4 9 1\n\x80\x80")(0, 7)[0], 255);
    EXPECT_EQ(read("P2 2 1 15 15 3")(0, 0)[0], 255) << "the header says what white is";
    EXPECT_EQ(read("P2 2 1 15 15 3")(0, 1)[0], 51);
    EXPECT_EQ(read(std::string("P5 2 1 1023\n\x03\xff\x01\xff", 16))(0, 0)[0], 255);
    EXPECT_EQ(read(std::string("P5 2 1 1023\n\x03\xff\x01\xff", 16))(0, 1)[0], 127);
    EXPECT_EQ(read("P2 2 1 1000 1000 500")(0, 1)[0], 128);
    const auto refusal = [&](const std::string& text) {
        return thrown_sentence([&] { read(text); });
    };
    EXPECT_NE(refusal("P2 2 1 255 7").find("cut off"), std::string::npos);
    EXPECT_NE(refusal("P2 2 1 255 7 x9 8 8").find("no number"), std::string::npos);
    EXPECT_NE(refusal("P2 2 1 255 7 256").find("256"), std::string::npos);
    EXPECT_NE(refusal("P5 2 1 70000\nabcd").find("70000"), std::string::npos);
}

TEST_F(ImageFileTest, WritesAMaskAsTheAlphaOfAPng) {
    const ColourImage image = some_picture(31, 23);
    cv::Mat1b alpha(image.size(), static_cast<unsigned char>(0));
    alpha(3, 5) = 255;
    write_with_alpha(path("a.png"), image, alpha);
    const cv::Mat bgra = cv::imread(path("a.png").string(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(bgra.type(), CV_8UC4);
    EXPECT_EQ(bgra.at<cv::Vec4b>(3, 5)[3], 255);
    EXPECT_EQ(bgra.at<cv::Vec4b>(3, 6)[3], 0);
    EXPECT_EQ(cv::norm(read_colour_image(path("a.png")), image, cv::NORM_INF), 0);
    write_with_alpha(path("a.jpg"), image, alpha);
    EXPECT_EQ(read_colour_image(path("a.jpg")).size(), image.size());
}

TEST_F(ImageFileTest, NamesTheFormatThatIsNotRead) {
    const auto refusal = [&](const std::string& text) {
        write_bytes(path("a.png"), std::as_bytes(std::span(text)));
        return thrown_sentence([&] { read_colour_image(path("a.png")); });
    };
    EXPECT_NE(refusal(std::string("II*\0abc", 7)).find("is a TIFF"), std::string::npos);
    EXPECT_NE(refusal("RIFF....WEBPVP8 ").find("is a WebP"), std::string::npos);
}

cv::Mat1w ramp_to(int white) {
    cv::Mat1w codes(16, 16);
    for (int i = 0; i < 256; ++i)
        codes(i / 16, i % 16) = static_cast<std::uint16_t>(std::lround(white * i / 255.0));
    return codes;
}

TEST_F(ImageFileTest, TheRangeOfDeepPicturesIsThatOfTheirCodes) {
    for (const int bits : {8, 10, 12, 14, 16}) {
        write_grey_image(path("deep.png"), ramp_to((1 << bits) - 1));
        const ColourImage picture = read_colour_image(path("deep.png"));
        for (int i = 0; i < 256; ++i)
            EXPECT_NEAR(picture(i / 16, i % 16)[0], i, 1) << bits << " bits";
    }
}

TEST_F(ImageFileTest, TheSidesOfARigHaveOneRange) {
    write_grey_image(path("left.png"), ramp_to(1023));
    write_grey_image(path("right.png"), ramp_to(250));
    const auto [left, right] = read_colour_pair(path("left.png"), path("right.png"));
    EXPECT_EQ(left(15, 15)[0], 255);
    EXPECT_NEAR(right(15, 15)[0], 250 * 255 / 1023, 1) << "darker, as the camera saw it";
    const std::vector<std::filesystem::path> files{path("right.png"), path("left.png"),
                                                   path("none.png")};
    EXPECT_EQ(common_code_range(files, 3), (CodeRange{1023}));
    EXPECT_EQ(common_code_range(files, 1), (CodeRange{255}));
    CodeRange range{255};
    (void)read_colour_image(path("left.png"), range);
    EXPECT_EQ(range, (CodeRange{1023}));
    EXPECT_EQ(range.bits(), 10);
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
