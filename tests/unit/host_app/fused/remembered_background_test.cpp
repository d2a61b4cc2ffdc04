#include <cstdlib>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "common/image/image_file.h"
#include "host_app/synthesis/source_map.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/view_sets/image_metrics.h"
#include "tests/unit/host_app/fused/wall_and_square.h"

namespace vantage {
namespace {

constexpr int width_px = 161, height_px = 121;
/// Instants until what stands still is the background: more than half a second, where no times are
/// told.
constexpr int long_enough = 16;

/// A patterned wall and, before it, a square around square_x_m, which walks.
DepthView film(double x_m, double square_x_m) {
    DepthView view =
        wall_and_square(x_m, width_px, height_px, {.square_x_m = square_x_m, .waves = true});
    view.name = "only";
    return view;
}

class RememberedBackgroundTest : public testing::Test {
  protected:
    void see(const DepthView& view, int instants = 1) {
        for (int i = 0; i < instants; ++i) synthesiser_->set_views({&view, 1});
    }
    ColourImage render() { return synthesiser_->render(target_).download(); }

    EglContext context_;
    ShaderLibrary shaders_;
    std::unique_ptr<Synthesiser> synthesiser_ = make_synthesiser("fused", shaders_);
    const DepthView truth_ = film(0.5, 0);
    const VirtualView target_{width_px, height_px, truth_.K, truth_.world_from_camera};
};

TEST_F(RememberedBackgroundTest, ShowsWhatTheForegroundHidesNowAndDidNotBefore) {
    see(film(0, 0));
    const ColourImage without = render();
    see(film(0, -1.2), long_enough);
    see(film(0, 0));
    const ColourImage with = render();
    if (const char* folder = std::getenv("VANTAGE_TEST_PICTURES")) {
        write_colour_image(std::string(folder) + "/plate-without.png", without);
        write_colour_image(std::string(folder) + "/plate-with.png", with);
    }
    EXPECT_EQ(remembered(without), 0);
    // The square hides 0.5 m of the wall, 16 px, over its height of 65 px.
    EXPECT_GT(remembered(with), 0.7 * 16 * 65 / (width_px * height_px));
    const cv::Mat1b hidden = [&] {
        cv::Mat1b alpha;
        cv::extractChannel(with, alpha, 3);
        return cv::Mat1b(alpha == remembered_alpha);
    }();
    EXPECT_LT(mean_error(with, truth_.colour, hidden), long_enough);
    EXPECT_GT(mean_error(without, truth_.colour, hidden), 16);
    // What is remembered was not seen; without it the wall ends a quad before the square.
    EXPECT_NEAR(coverage(with), coverage(without), 0.01);
}

TEST_F(RememberedBackgroundTest, OutlivesACutButNotAnotherCalibration) {
    see(film(0, -1.2), long_enough);
    synthesiser_->cut();
    see(film(0, 0));
    EXPECT_GT(remembered(render()), 0.7 * 16 * 65 / (width_px * height_px));

    see(film(0.01, -1.2), long_enough);
    see(film(0, 0));
    EXPECT_EQ(remembered(render()), 0);
}

TEST_F(RememberedBackgroundTest, OutlivesOneWrongDepth) {
    see(film(0, -1.2), long_enough);
    DepthView wrong = film(0, 0);
    wrong.depth_m.setTo(9.0f);
    see(wrong);
    // Twice more, until the depth filter believes it too.
    see(film(0, 0), 3);
    const ColourImage picture = render();
    cv::Mat1b alpha;
    cv::extractChannel(picture, alpha, 3);
    EXPECT_GT(remembered(picture), 0.7 * 16 * 65 / (width_px * height_px));
    EXPECT_LT(mean_error(picture, truth_.colour, alpha == remembered_alpha), long_enough);
}

/// The square stood still long enough to be learnt, and went: what lies behind it is seen.
TEST_F(RememberedBackgroundTest, DoesNotShowWhatHasGone) {
    see(film(0, 0), long_enough);
    see(film(0, 3));
    const DepthView empty = film(0.5, 3);
    const ColourImage picture = render();
    EXPECT_LT(mean_error(picture, empty.colour, covered_mask(picture)), 3);
    for (int y = 0; y < height_px; ++y)
        for (int x = 0; x < width_px; ++x) {
            if (picture(y, x)[3] != remembered_alpha) continue;
            ASSERT_LT(picture(y, x)[0], 100) << "red of the square at " << x << ", " << y;
        }
}

TEST_F(RememberedBackgroundTest, IsCountedSeparatelyByTheSourceMap) {
    ASSERT_TRUE(synthesiser_->note_origins(true));
    see(film(0, -1.2), long_enough);
    see(film(0, 0));
    const ColourImage picture = render();
    const SourceShares shares = source_shares(picture, *synthesiser_->origins());
    EXPECT_NEAR(shares.remembered, remembered(picture), 1e-9);
    EXPECT_GT(shares.remembered, 0.01);
    EXPECT_NEAR(shares.rigs.at("only") + shares.filled + shares.remembered, 1, 1e-6);
}

}  // namespace
}  // namespace vantage
