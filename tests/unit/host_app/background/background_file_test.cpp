#include "host_app/background/background_file.h"

#include <filesystem>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "common/base/files/atomic_file.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using testing::HasSubstr;

RigBackground rig_background(const std::string& name, cv::Size colour_size, cv::Size depth_size) {
    cv::RNG random(7);
    RigBackground rig{name, "fnv1a64:0123456789abcdef", ColourImage(colour_size),
                      DepthImage(depth_size), cv::Mat1b(depth_size)};
    random.fill(rig.colour, cv::RNG::UNIFORM, 0, 256);
    random.fill(rig.depth_m, cv::RNG::UNIFORM, 0.5, 9);
    random.fill(rig.certainty, cv::RNG::UNIFORM, 0, 256);
    rig.depth_m(1, 2) = 0;
    return rig;
}

Background two_rigs() {
    return {
        tai_from_ns(1'700'000'000'000'000'000),
        {rig_background("rig-a", {31, 17}, {31, 17}), rig_background("rig-b", {40, 30}, {20, 15})}};
}

bool are_same(const cv::Mat& a, const cv::Mat& b) {
    return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

TEST(BackgroundFile, LoadsExactlyWhatWasSaved) {
    const Background set = two_rigs();
    const auto path = std::filesystem::temp_directory_path() / "vantage_set_file_test.vset";
    save_background(set, path);
    const Background loaded = load_background(path);
    std::filesystem::remove(path);
    EXPECT_EQ(loaded.learnt, set.learnt);
    ASSERT_EQ(loaded.rigs.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(loaded.rigs[i].rig, set.rigs[i].rig);
        EXPECT_EQ(loaded.rigs[i].calibration, set.rigs[i].calibration);
        EXPECT_TRUE(are_same(loaded.rigs[i].colour, set.rigs[i].colour));
        EXPECT_TRUE(are_same(loaded.rigs[i].depth_m, set.rigs[i].depth_m));
        EXPECT_TRUE(are_same(loaded.rigs[i].certainty, set.rigs[i].certainty));
    }
}

TEST(BackgroundFile, RefusesAnIncompleteFile) {
    const std::vector<std::byte> whole = encode_background(two_rigs());
    for (std::size_t bytes = 0; bytes < whole.size(); bytes += 1 + bytes / 16)
        EXPECT_THROW(decode_background(std::span(whole).first(bytes)), Error) << bytes;
}

TEST(BackgroundFile, NamesTheFileAndTheProblem) {
    const auto path = std::filesystem::temp_directory_path() / "vantage_no_set.vset";
    const std::string text = "a picture, perhaps";
    write_file_atomically(path, std::as_bytes(std::span(text)));
    EXPECT_THAT(thrown_sentence([&] { load_background(path); }),
                testing::AllOf(HasSubstr(path.string()), HasSubstr("not a background file")));
    std::filesystem::remove(path);
    EXPECT_THAT(thrown_sentence([&] { load_background(path); }), HasSubstr(path.string()));
}

TEST(BackgroundFile, RefusesInvalidDepth) {
    Background set = two_rigs();
    set.rigs[0].depth_m(3, 3) = -1;
    EXPECT_THAT(thrown_sentence([&] { decode_background(encode_background(set)); }),
                HasSubstr("outside 0.."));
    set.rigs[0].depth_m(3, 3) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(decode_background(encode_background(set)), Error);
}

TEST(BackgroundFile, RefusesTooManyPixelsBeforeItAllocatesMemory) {
    Background set;
    // Zeros compress to almost nothing.
    RigBackground large{"rig-a", "fnv1a64:0", ColourImage(1, 1, cv::Vec4b()),
                        DepthImage(4096, 4096, 0.0f), cv::Mat1b(4096, 4096, uchar{0})};
    for (int i = 0; i < 5; ++i) set.rigs.push_back(large);
    EXPECT_THAT(thrown_sentence([&] { decode_background(encode_background(set)); }),
                HasSubstr("more than the 67108864 pixels"));
}

TEST(BackgroundFile, TheChecksumDependsOnEveryPartOfTheCalibration) {
    DepthView camera;
    const cv::Size size(320, 240);
    const std::string one = calibration_of(camera, size, size);
    EXPECT_EQ(calibration_of(camera, size, size), one);
    EXPECT_NE(calibration_of(camera, size, {160, 120}), one);
    DepthView moved = camera;
    moved.world_from_camera.translation().x() += 1e-6;
    EXPECT_NE(calibration_of(moved, size, size), one);
    DepthView other = camera;
    other.K(0, 0) += 1e-6;
    EXPECT_NE(calibration_of(other, size, size), one);
}

}  // namespace
}  // namespace vantage
