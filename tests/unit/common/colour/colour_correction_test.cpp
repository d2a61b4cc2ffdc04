#include "common/colour/colour_correction.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/colour/colour_file.h"
#include "common/colour/colour_pass.h"
#include "common/gl/context/egl_context.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using testing::HasSubstr;

ColourCorrection warm() {
    ColourCorrection c;
    c.matrix << 1.1, 0.05, -0.02, 0.03, 0.95, 0.01, 0, -0.04, 0.8;
    c.tone = {1.05, 0.97, 1.2};
    return c;
}

ColourImage noise() {
    ColourImage picture(47, 61);
    cv::RNG(5).fill(picture, cv::RNG::UNIFORM, 0, 256);
    return picture;
}

TEST(ColourCorrection, identity_changes_nothing) {
    EXPECT_EQ(cv::norm(ColourCorrection{}.apply(noise()), noise(), cv::NORM_INF), 0);
}

TEST(ColourCorrection, passes_on_the_gpu_as_in_the_reference) {
    const EglContext context;
    const ShaderLibrary shaders;
    ColourPass pass(shaders);
    Texture camera(TextureFormat::rgba8, 61, 47), stage(TextureFormat::rgba8, 61, 47);
    camera.upload(noise());
    pass.correct(camera, warm(), Framebuffer({&stage}));
    EXPECT_LE(cv::norm(stage.download(), warm().apply(noise()), cv::NORM_INF), 1);
    EXPECT_GT(cv::norm(stage.download(), noise(), cv::NORM_INF), 20);
}

TEST(ColourFile, reads_what_it_wrote_and_keeps_the_last_good_one) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "a.toml";
    save_colour(file, warm(), {"2026-01-01", "test", "chart", 5.5, 0.4, 24});
    EXPECT_TRUE(load_colour(file).matrix.isApprox(warm().matrix, 1e-8));
    EXPECT_TRUE(load_colour(file).tone.isApprox(warm().tone, 1e-8));
    save_colour(file, {}, {});
    EXPECT_TRUE(load_colour(file).is_identity());
    EXPECT_TRUE(load_colour(file.string() + ".last").matrix.isApprox(warm().matrix, 1e-8));
}

TEST(ColourFile, refuses_what_cannot_be) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "a.toml";
    EXPECT_THAT(thrown_sentence([&] { load_colour(file); }), HasSubstr("a.toml"));
    std::ofstream(file) << "version = 1\nmatrix = [1,0,0, 0,1,0, 0,0,99]\ntone = [1,1,1]\n";
    EXPECT_THAT(thrown_sentence([&] { load_colour(file); }), HasSubstr("row 3, column 3"));
    std::ofstream(file) << "version = 1\nmatrix = [1,0,0, 0,1,0, 0,0,1]\ntone = [1,0,1]\n";
    EXPECT_THAT(thrown_sentence([&] { load_colour(file); }), HasSubstr("tone of channel 2"));
    std::ofstream(file) << "version = 1\nmatrix = [1,0,0]\ntone = [1,1,1]\n";
    EXPECT_THAT(thrown_sentence([&] { load_colour(file); }), HasSubstr("matrix"));
}

}  // namespace
}  // namespace vantage
