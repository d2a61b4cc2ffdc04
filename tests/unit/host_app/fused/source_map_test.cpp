#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "host_app/synthesis/source_map.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

constexpr int overlay_width_px = 61, overlay_height_px = 47;

/// A grey wall at z = 4 m, seen from (x, 0, 0) along z; depth is known from a row on.
DepthView wall(const std::string& name, double x_m, int from_row = 0) {
    DepthView view;
    view.name = name;
    view.K << 50, 0, 30, 0, 50, 23, 0, 0, 1;
    view.world_from_camera.translation().x() = x_m;
    view.colour = ColourImage(overlay_height_px, overlay_width_px, cv::Vec4b(128, 128, 128, 255));
    view.depth_m = DepthImage(overlay_height_px, overlay_width_px, 0.0f);
    view.depth_m.rowRange(from_row, overlay_height_px).setTo(4.0f);
    return view;
}

class SourceMapTest : public testing::TestWithParam<const char*> {
  protected:
    EglContext context_;
    ShaderLibrary shaders_;
    std::unique_ptr<Synthesiser> synthesiser_ = make_synthesiser(GetParam(), shaders_);
    SourceMapOverlay overlay_{shaders_};
    const VirtualView target_{overlay_width_px, overlay_height_px, wall("", 0).K, Pose::Identity()};
};

TEST_P(SourceMapTest, GivesEveryPixelToTheRigsThatShowIt) {
    ASSERT_TRUE(synthesiser_->note_origins(true));
    overlay_.name_rigs({"west", "east"});
    // Rays 0.2 m aside at 4 m: 2.5 px.
    const DepthView views[] = {wall("west", -0.2), wall("east", 0.2)};
    synthesiser_->set_views(views);
    const Texture& plain = synthesiser_->render(target_);
    const PixelOrigins* origins = synthesiser_->origins();
    ASSERT_NE(origins, nullptr);
    const ColourImage picture = plain.download();
    const ColourImage shares = origins->shares->download();
    // Half way, both count the same.
    const cv::Vec4b middle = shares(23, 30);
    double of_west = 0, of_east = 0;
    for (std::size_t i = 0; i < origins->rigs.size(); ++i)
        (origins->rigs[i] == "west" ? of_west : of_east) += middle[static_cast<int>(i)] / 255.0;
    EXPECT_NEAR(of_west, 0.5, 0.1);
    EXPECT_NEAR(of_east, 0.5, 0.1);

    const ColourImage overlaid = overlay_.lay(plain, *origins).download();
    for (int y = 0; y < overlay_height_px; ++y)
        for (int x = 0; x < overlay_width_px; ++x)
            ASSERT_EQ(overlaid(y, x)[3], picture(y, x)[3]) << "alpha still says what is known";
    const SourceShares sums = source_shares(picture, *origins);
    EXPECT_NEAR(sums.rigs.at("west") + sums.rigs.at("east") + sums.filled, 1, 1e-6);
    EXPECT_NEAR(sums.rigs.at("west"), sums.rigs.at("east"), 0.1);
}

TEST_P(SourceMapTest, PaintsARigsOwnPixelsInItsColourAndHatchesWhatNoneHasSeen) {
    ASSERT_TRUE(synthesiser_->note_origins(true));
    overlay_.name_rigs({"west", "east"});
    // Rays 1.5 m aside at 4 m: 19 px. Above row 14 none knows depth; fused guesses it at most.
    const DepthView views[] = {wall("east", 1.5, 14), wall("west", -1.5, 14)};
    synthesiser_->set_views(views);
    const Texture& plain = synthesiser_->render(target_);
    const ColourImage picture = plain.download();
    const ColourImage overlaid = overlay_.lay(plain, *synthesiser_->origins()).download();
    const auto nearest_rig = [&](int x) {
        const cv::Vec4b& c = overlaid(30, x);
        const auto off = [&](std::size_t rig) {
            const cv::Vec3b key = overlay_.legend()[rig].colour;
            const double bright = (c[0] + c[1] + c[2]) / double(key[0] + key[1] + key[2]);
            return cv::norm(cv::Vec3d(c[0], c[1], c[2]) - bright * cv::Vec3d(key));
        };
        return overlay_.legend()[off(0) < off(1) ? 0 : 1].rig;
    };
    EXPECT_EQ(nearest_rig(8), "west");
    EXPECT_EQ(nearest_rig(52), "east");
    int hatched = 0;
    for (int x = 0; x < 8; ++x) {
        ASSERT_LT(picture(2, x)[3], 128);
        hatched += overlaid(2, x)[0] == 255 && overlaid(2, x)[1] == 0;
    }
    EXPECT_EQ(hatched, 4);
    EXPECT_GT(source_shares(picture, *synthesiser_->origins()).filled, 8.0 / overlay_height_px);
}

TEST_P(SourceMapTest, LeavesThePictureAsItIs) {
    const DepthView views[] = {wall("west", -0.2, 5), wall("east", 0.2, 20)};
    synthesiser_->set_views(views);
    const ColourImage before = synthesiser_->render(target_).download();
    EXPECT_EQ(synthesiser_->origins(), nullptr);
    ASSERT_TRUE(synthesiser_->note_origins(true));
    const ColourImage noting = synthesiser_->render(target_).download();
    EXPECT_LE(cv::norm(before, noting, cv::NORM_INF), 1);
    ASSERT_TRUE(synthesiser_->note_origins(false));
    synthesiser_->render(target_);
    EXPECT_EQ(synthesiser_->origins(), nullptr);
}

INSTANTIATE_TEST_SUITE_P(All, SourceMapTest, testing::Values("mesh", "layered", "fused"),
                         [](const auto& test) { return std::string(test.param); });

TEST(SourceMapOverlay, SaysWhichSynthesiserCannotTell) {
    const EglContext context;
    const ShaderLibrary shaders;
    const auto points = make_synthesiser("points", shaders);
    const std::string sentence =
        thrown_sentence([&] { SourceMapOverlay::require(points->note_origins(true), "points"); });
    EXPECT_NE(sentence.find("'points' cannot tell"), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("take fused"), std::string::npos) << sentence;
}

TEST(SourceMapColours, AreTenDistinctOnesAtLeast) {
    for (std::size_t a = 0; a < 10; ++a)
        for (std::size_t b = 0; b < a; ++b)
            EXPECT_GT(cv::norm(cv::Vec3d(source_colour(a)) - cv::Vec3d(source_colour(b))), 40)
                << a << ", " << b;
}

}  // namespace
}  // namespace vantage
