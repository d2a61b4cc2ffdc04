#include "rig_firmware/capture/material/stereo_material.h"

#include <fstream>

#include <gtest/gtest.h>
#include <opencv2/videoio.hpp>

#include "common/image/image_file.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

class StereoMaterialTest : public testing::Test {
  protected:
    std::string at(const std::string& name) const { return (folder_.path() / name).string(); }
    /// A picture that is grey of this value.
    void write(const std::string& name, int grey, cv::Size size = {31, 17}) const {
        write_colour_image(at(name), ColourImage(size, cv::Vec4b::all(static_cast<uchar>(grey))));
    }
    static int grey(const ColourImage& picture) { return picture(3, 3)[1]; }
    std::string fault(const RigConfig::Source& source) const {
        return thrown_sentence([&] {
            const auto material = open_material(source);
            while (material->pair_of(pulse_++ % 1000)) {
            }
        });
    }

    TemporaryFolder folder_;
    mutable std::uint64_t pulse_ = 0;
};

TEST_F(StereoMaterialTest, PlaysASinglePairOnceOrForEver) {
    write("l.png", 10);
    write("r.png", 20);
    const auto looping = open_material({.left = at("l.png"), .right = at("r.png")});
    EXPECT_EQ(looping->size(), cv::Size(31, 17));
    for (std::uint64_t pulse = 100; pulse < 103; ++pulse) {
        const auto pair = looping->pair_of(pulse);
        ASSERT_TRUE(pair);
        EXPECT_EQ(grey(pair->left), 10);
        EXPECT_EQ(grey(pair->right), 20);
    }
    const auto once = open_material({.left = at("l.png"), .right = at("r.png"), .loop = false});
    EXPECT_TRUE(once->pair_of(7));
    EXPECT_FALSE(once->pair_of(8));
}

TEST_F(StereoMaterialTest, TakesNamesAsTheyAre) {
    std::filesystem::create_directory(folder_.path() / "rig 50% [1]");
    for (const char* name : {"l[1].png", "shot 50%.png", "a\nb.png"}) {
        const std::string file = std::string("rig 50% [1]/") + name;
        write(file, 30);
        EXPECT_EQ(grey(open_material({.left = at(file), .right = at(file)})->pair_of(0)->left), 30)
            << name;
    }
    write("rig 50% [1]/n07.png", 40);
    const std::string pattern = at("rig 50% [1]/n%02d.png");
    const auto numbered = open_material({.left = pattern, .right = pattern, .first = 7});
    EXPECT_EQ(grey(numbered->pair_of(0)->left), 40);
}

TEST_F(StereoMaterialTest, ScalesDeepPicturesOfASeriesAlike) {
    for (int i = 0; i < 3; ++i) {
        const int white = i == 1 ? 1023 : 200;
        write_grey_image(at(fmt::format("l{}.png", i)),
                         cv::Mat1w(17, 31, static_cast<ushort>(white)));
        write_grey_image(at(fmt::format("r{}.png", i)),
                         cv::Mat1w(17, 31, static_cast<ushort>(100)));
    }
    const auto series = open_material({.left = at("l%d.png"), .right = at("r%d.png")});
    const auto dark = series->pair_of(0), bright = series->pair_of(1);
    EXPECT_NEAR(grey(dark->left), 200 * 255 / 1023, 1);
    EXPECT_EQ(grey(bright->left), 255);
    EXPECT_NEAR(grey(bright->right), 100 * 255 / 1023, 1);
}

TEST_F(StereoMaterialTest, CutsSideBySidePictures) {
    ColourImage both(17, 62, cv::Vec4b(1, 1, 1, 255));
    both.colRange(31, 62).setTo(cv::Vec4b(2, 2, 2, 255));
    write_colour_image(at("b.png"), both);
    const auto pair = open_material({.left = at("b.png")})->pair_of(0);
    EXPECT_EQ(grey(pair->left), 1);
    EXPECT_EQ(grey(pair->right), 2);
    EXPECT_EQ(pair->right.size(), cv::Size(31, 17));
    write("odd.png", 0, {61, 17});
    EXPECT_NE(fault({.left = at("odd.png")}).find("even width"), std::string::npos);
}

TEST_F(StereoMaterialTest, BindsLoopingPicturesToThePulse) {
    for (int i = 5; i < 8; ++i) {
        write("l" + std::to_string(i) + ".png", i);
        write("r" + std::to_string(i) + ".png", 10 * i);
    }
    RigConfig::Source source = {.left = at("l%d.png"), .right = at("r%d.png"), .first = 5};
    const auto one = open_material(source), other = open_material(source);
    EXPECT_EQ(grey(one->pair_of(3001)->left), 6);
    EXPECT_EQ(grey(one->pair_of(3003)->left), 5);
    EXPECT_EQ(grey(other->pair_of(3004)->right), 60);
    source.frames = 1;
    const auto alone = open_material(source);
    EXPECT_EQ(grey(alone->pair_of(3001)->left), 5) << "no more than stated";
}

/// Videos of 12 frames whose grey is 10 times their number, in two codecs: every frame is a key
/// frame, and frames depend on earlier ones.
class VideoInStep : public StereoMaterialTest, public testing::WithParamInterface<const char*> {
  protected:
    RigConfig::Source film(const char* codec) const {
        const std::string name = at(std::string("film") + codec + ".mkv");
        cv::VideoWriter writer(
            name, cv::VideoWriter::fourcc(codec[0], codec[1], codec[2], codec[3]), 25, {64, 48});
        if (!writer.isOpened()) return {};
        for (int i = 0; i < 12; ++i) writer.write(cv::Mat3b(48, 64, cv::Vec3b::all(uchar(10 * i))));
        writer.release();
        return {.left = name, .right = name};
    }
};

TEST_P(VideoInStep, ShowsTheFrameOfThePulseWheneverItIsStarted) {
    const RigConfig::Source source = film(GetParam());
    if (source.left.empty()) GTEST_SKIP() << "SKIPPED: OpenCV writes no video with " << GetParam();
    const auto number = [&](StereoMaterial& material, std::uint64_t pulse) {
        const auto pair = material.pair_of(pulse);
        return pair ? (grey(pair->right) + 5) / 10 : -1;
    };
    for (const std::uint64_t first : {12'000u, 12'005u, 12'011u}) {
        const auto material = open_material(source);
        for (std::uint64_t pulse = first; pulse < first + 30; ++pulse)
            ASSERT_EQ(number(*material, pulse), static_cast<int>(pulse % 12))
                << "first pulse " << first;
    }
    // After missed pulses the video is in step at once, however long a frame takes.
    RigConfig::Source fast = source;
    fast.rate_hz = 1e9;
    const auto material = open_material(fast);
    EXPECT_EQ(number(*material, 12'001), 1);
    testing::internal::CaptureStderr();
    EXPECT_EQ(number(*material, 12'004), 4);
    const std::string log = testing::internal::GetCapturedStderr();
    EXPECT_NE(log.find("frames are left out to stay in step with other rigs"), std::string::npos)
        << log;
    EXPECT_EQ(number(*material, 12'010), 10);
    EXPECT_EQ(number(*material, 12'027), 3) << "in the next round";
    EXPECT_EQ(number(*material, 12'027 + 12'000'009), 0) << "a million rounds later";
    EXPECT_EQ(number(*material, 12'026), 2) << "after the clock was set back";
}

TEST_P(VideoInStep, ShowsNoMoreFramesThanStated) {
    RigConfig::Source source = film(GetParam());
    if (source.left.empty()) GTEST_SKIP() << "SKIPPED: OpenCV writes no video with " << GetParam();
    source.frames = 5;
    const auto looping = open_material(source);
    EXPECT_NE(looping->describe().find("looping over 5 frames"), std::string::npos);
    for (std::uint64_t pulse = 9001; pulse < 9020; ++pulse) {
        const auto pair = looping->pair_of(pulse);
        ASSERT_TRUE(pair);
        EXPECT_EQ((grey(pair->left) + 5) / 10, static_cast<int>(pulse % 5));
    }
    source.loop = false;
    const auto once = open_material(source);
    EXPECT_TRUE(once->pair_of(9001));
    EXPECT_TRUE(once->pair_of(9005));
    EXPECT_FALSE(once->pair_of(9006));
    EXPECT_EQ(once->unshown(), 0u);
    EXPECT_NE(open_material({.left = source.left, .right = source.right, .frames = 50})
                  ->describe()
                  .find("looping over 12 frames"),
              std::string::npos);
}

TEST_P(VideoInStep, LeavesOutFramesOfMissedPulsesAndEndsWithoutLooping) {
    RigConfig::Source source = film(GetParam());
    if (source.left.empty()) GTEST_SKIP() << "SKIPPED: OpenCV writes no video with " << GetParam();
    source.loop = false;
    const auto material = open_material(source);
    EXPECT_EQ(grey(material->pair_of(7000)->left), 0);
    const auto later = material->pair_of(7005);
    ASSERT_TRUE(later);
    EXPECT_EQ((grey(later->right) + 5) / 10, 5);
    EXPECT_FALSE(material->pair_of(7012));
    EXPECT_EQ(material->unshown(), 6u) << "frames 6 to 11";
}

INSTANTIATE_TEST_SUITE_P(Codecs, VideoInStep, testing::Values("MJPG", "MP4V"));

TEST_F(StereoMaterialTest, LeavesOutPicturesOfMissedPulsesAndEnds) {
    for (int i = 0; i < 4; ++i) write("b" + std::to_string(i) + ".png", i, {62, 17});
    const auto material = open_material({.left = at("b%d.png"), .loop = false});
    EXPECT_EQ(grey(material->pair_of(1000)->left), 0);
    EXPECT_EQ(grey(material->pair_of(1003)->right), 3);
    EXPECT_FALSE(material->pair_of(1004));
}

TEST_F(StereoMaterialTest, NamesTheFileThatIsMissingDamagedOrOfAnotherSize) {
    write("l.png", 1);
    write("wide.png", 1, {33, 17});
    std::ofstream(at("torn.png")) << "\x89PNG\r\n\x1a\n and no more";
    std::ofstream(at("text.txt")) << "no picture";
    const auto names = [&](const RigConfig::Source& source, const std::string& name) {
        const std::string sentence = fault(source);
        EXPECT_NE(sentence.find(name), std::string::npos) << sentence;
        EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
    };
    names({}, "'left'");
    names({.left = at("none.png"), .right = at("l.png")}, "none.png");
    names({.left = at("l.png"), .right = at("none.png")}, "none.png");
    names({.left = at("l.png"), .right = at("wide.png")}, "31x17");
    names({.left = at("l.png"), .right = at("torn.png")}, "torn.png");
    names({.left = at("torn.png")}, "torn.png");
    names({.left = at("text.txt")}, "text.txt");
    names({.left = at("none.mkv")}, "none.mkv");
    names({.left = folder_.path().string()}, folder_.path().string());
    names({.left = at("l%d.png"), .right = at("l.png")}, "l0.png");
    names({.left = at("l.png"), .right = at("l%d.png")}, "l.png");
}

TEST_F(StereoMaterialTest, RefusesNumberedPicturesThatDoNotFitTogether) {
    for (int i = 0; i < 3; ++i) write("l" + std::to_string(i) + ".png", i);
    for (int i = 0; i < 2; ++i) write("r" + std::to_string(i) + ".png", i);
    const RigConfig::Source source = {.left = at("l%d.png"), .right = at("r%d.png")};
    EXPECT_NE(fault(source).find("3 left pictures"), std::string::npos);
    EXPECT_NE(fault({.left = at("l%d.png"), .right = at("r0.png")}).find("single one"),
              std::string::npos);
    write("r2.png", 2, {29, 17});
    EXPECT_NE(fault(source).find("29x17"), std::string::npos);
    write("l2.png", 2, {29, 17});
    EXPECT_NE(fault(source).find("one size"), std::string::npos);
}

TEST_F(StereoMaterialTest, PlaysAVideoPictureByPicture) {
    {
        cv::VideoWriter writer(at("v.avi"), cv::CAP_OPENCV_MJPEG,
                               cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25, {64, 32});
        ASSERT_TRUE(writer.isOpened());
        for (int i = 0; i < 3; ++i) {
            cv::Mat3b picture(32, 64, cv::Vec3b::all(static_cast<uchar>(40 + 50 * i)));
            picture.colRange(32, 64).setTo(cv::Vec3b(0, 0, 200));
            writer.write(picture);
        }
    }
    const auto once = open_material({.left = at("v.avi"), .loop = false});
    EXPECT_EQ(once->size(), cv::Size(32, 32));
    for (int i = 0; i < 3; ++i) {
        const auto pair = once->pair_of(static_cast<std::uint64_t>(50 + i));
        ASSERT_TRUE(pair) << i;
        EXPECT_NEAR(grey(pair->left), 40 + 50 * i, 4);
        EXPECT_NEAR(pair->right(3, 20)[0], 200, 12) << "red comes first";
        EXPECT_NEAR(pair->right(3, 20)[2], 0, 12);
        EXPECT_EQ(pair->right(3, 20)[3], 255);
    }
    EXPECT_FALSE(once->pair_of(53));
    EXPECT_EQ(once->unshown(), 0u);
    const auto looping = open_material({.left = at("v.avi")});
    for (std::uint64_t i = 0; i < 7; ++i)
        EXPECT_NEAR(grey(looping->pair_of(i)->left), 40 + 50 * static_cast<int>(i % 3), 4);
}

TEST_F(StereoMaterialTest, NamesAVideoThatPlayersShowTurned) {
    const std::string name = at("take: 1.mp4");
    {
        cv::VideoWriter writer(name, cv::VideoWriter::fourcc('m', 'p', '4', 'v'), 25, {64, 48});
        if (!writer.isOpened()) GTEST_SKIP() << "SKIPPED: OpenCV writes no MP4";
        for (int i = 0; i < 3; ++i) writer.write(cv::Mat3b(48, 64, cv::Vec3b::all(90)));
    }
    const auto log_of_opening = [&] {
        testing::internal::CaptureStderr();
        EXPECT_EQ(open_material({.left = name, .right = name})->size(), cv::Size(64, 48));
        return testing::internal::GetCapturedStderr();
    };
    EXPECT_EQ(log_of_opening(), "");
    // The matrix of the track's header, as a phone that is held upright writes it.
    std::fstream file(name, std::ios::binary | std::ios::in | std::ios::out);
    const std::string bytes(std::istreambuf_iterator<char>(file), {});
    const std::size_t header = bytes.find("tkhd");
    ASSERT_NE(header, std::string::npos);
    constexpr std::size_t to_matrix = 44;
    const char clockwise[] = {0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, char(0xff), char(0xff), 0, 0};
    file.seekp(static_cast<std::streamoff>(header + to_matrix));
    file.write(clockwise, sizeof clockwise);
    file.close();
    EXPECT_NE(log_of_opening().find("turned by 90 degrees clockwise"), std::string::npos);
}

TEST_F(StereoMaterialTest, PlaysTwoVideosSideBySideAndEndsARoundWithTheShorterOne) {
    const auto film = [&](const std::string& name, int pictures, int base, cv::Size size) {
        cv::VideoWriter writer(at(name), cv::CAP_OPENCV_MJPEG,
                               cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25, size);
        for (int i = 0; i < pictures; ++i)
            writer.write(cv::Mat3b(size, cv::Vec3b::all(static_cast<uchar>(base + 50 * i))));
    };
    film("l.avi", 3, 40, {64, 32});
    film("r.avi", 4, 20, {64, 32});
    film("small.avi", 3, 20, {32, 32});
    const auto material = open_material({.left = at("l.avi"), .right = at("r.avi")});
    EXPECT_EQ(material->size(), cv::Size(64, 32));
    EXPECT_DOUBLE_EQ(material->rate_hz(), 25);
    for (std::uint64_t i = 0; i < 8; ++i) {
        const auto pair = material->pair_of(i);
        ASSERT_TRUE(pair) << i;
        EXPECT_NEAR(grey(pair->left), 40 + 50 * static_cast<int>(i % 3), 4);
        EXPECT_NEAR(grey(pair->right), 20 + 50 * static_cast<int>(i % 3), 4);
    }
    const auto once = open_material({.left = at("r.avi"), .right = at("l.avi"), .loop = false});
    for (std::uint64_t i = 0; i < 3; ++i) EXPECT_TRUE(once->pair_of(i));
    EXPECT_FALSE(once->pair_of(3));
    EXPECT_NE(fault({.left = at("l.avi"), .right = at("small.avi")}).find("must have one size"),
              std::string::npos);
    EXPECT_NE(fault({.left = at("l.avi"), .right = at("none.avi")}).find("is no file"),
              std::string::npos);
}

TEST_F(StereoMaterialTest, PlaysWhatShellPatternsAndFoldersName) {
    std::filesystem::create_directory(at("left"));
    std::filesystem::create_directory(at("right"));
    for (const int number : {2, 9, 10}) {
        write("left/l_" + std::to_string(number) + ".png", number);
        write("right/r_" + std::to_string(number) + ".png", 100 + number);
    }
    for (const char* pattern : {"", "/*.png", "/?_*"}) {
        const auto material = open_material({.left = at(std::string("left") + pattern),
                                             .right = at(std::string("right") + pattern)});
        const int numbers[] = {2, 9, 10};
        for (std::uint64_t pulse = 0; pulse < 5; ++pulse) {
            const auto pair = material->pair_of(pulse);
            EXPECT_EQ(grey(pair->left), numbers[pulse % 3]) << pattern;
            EXPECT_EQ(grey(pair->right), 100 + numbers[pulse % 3]) << pattern;
        }
    }
    write("left/l_11.png", 1);
    EXPECT_NE(fault({.left = at("left"), .right = at("right")}).find("l_11.png has no partner"),
              std::string::npos);
    EXPECT_NE(fault({.left = at("none*.png"), .right = at("right")}).find("no file matches"),
              std::string::npos);
}

TEST_F(StereoMaterialTest, PlaysARealPairBitByBit) {
    VANTAGE_REQUIRE_DATA(data);
    const auto left = data / "middlebury2003/teddy/im2.png";
    const auto material =
        open_material({.left = left, .right = data / "middlebury2003/teddy/im6.png"});
    EXPECT_EQ(material->size(), cv::Size(450, 375));
    EXPECT_EQ(cv::norm(material->pair_of(1)->left, read_colour_image(left), cv::NORM_INF), 0);
}

}  // namespace
}  // namespace vantage
