#include "host_app/baked/baked_painter.h"

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "tests/unit/host_app/fused/wall_and_square.h"

namespace vantage {
namespace {

constexpr int drawn_width_px = 96, drawn_height_px = 72;

/// A wall of one colour behind a square, or without it.
DepthView coloured_view(double x_m, const cv::Vec4b& wall, bool has_square = true) {
    DepthView view = wall_and_square(x_m, drawn_width_px, drawn_height_px,
                                     {.square_x_m = has_square ? 0.0 : 100.0});
    view.baseline_m = 0.2;
    for (int y = 0; y < drawn_height_px; ++y)
        for (int x = 0; x < drawn_width_px; ++x)
            if (view.depth_m(y, x) == 4.0f) view.colour(y, x) = wall;
    return view;
}

VirtualView virtual_view_at(double x_m) {
    VirtualView view{drawn_width_px, drawn_height_px, coloured_view(x_m, {}).K};
    view.world_from_camera.translation().x() = x_m;
    return view;
}

class BakedPainterTest : public testing::Test {
  protected:
    static std::shared_ptr<BakedInstant> instant_of(const std::vector<DepthView>& views) {
        const auto surface = std::make_shared<BakedSurface>();
        surface->upload(*bake_background(views));
        auto instant = std::make_shared<BakedInstant>();
        instant->background = surface;
        instant->colours.resize(views.size());
        return instant;
    }
    const DepthPicture& draw(const BakedInstant& instant, double x_m,
                             const std::vector<std::string>& origins = {}) {
        return painter_.draw(instant, virtual_view_at(x_m), 0.04, origins, true, 0.375f);
    }

    EglContext context_;
    ShaderLibrary shaders_;
    BakedPainter painter_{shaders_};
};

TEST_F(BakedPainterTest, DrawsAPlaneWithItsColourAndDepth) {
    const auto instant = instant_of({coloured_view(0, {10, 200, 30, 255}, false)});
    const DepthPicture& picture = draw(*instant, 0);
    const ColourImage colour = picture.colour().download();
    const DepthImage depth_m = picture.depth_m().download();
    for (int y = 0; y < drawn_height_px; ++y)
        for (int x = 0; x < drawn_width_px; ++x) {
            ASSERT_EQ(colour(y, x), cv::Vec4b(10, 200, 30, 255)) << x << ' ' << y;
            ASSERT_NEAR(depth_m(y, x), 4, 0.001) << x << ' ' << y;
        }
}

/// Both rigs see most of the wall and mix there; what the square hides from one of them has the
/// colour of the other one alone.
TEST_F(BakedPainterTest, TakesNoColourFromARigThatAPlaceIsHiddenFrom) {
    const cv::Vec4b blue(0, 0, 200, 255), green(0, 200, 0, 255);
    const auto instant = instant_of({coloured_view(-0.5, blue), coloured_view(0.5, green)});
    const ColourImage picture = draw(*instant, 0).colour().download();
    const VirtualView view = virtual_view_at(0);
    const auto at_wall = [&](double x_m, double y_m) {
        return picture(cvRound(view.K(1, 2) + view.K(1, 1) * y_m / 4),
                       cvRound(view.K(0, 2) + view.K(0, 0) * x_m / 4));
    };
    // The square covers -0.5..0.5 at 2 m: on the wall from 0, -1..1; from 0.5, -1.5..0.5.
    EXPECT_EQ(at_wall(-1.25, 0), blue);
    EXPECT_EQ(at_wall(1.25, 0), green);
    const cv::Vec4b both = at_wall(0, 1.3);
    EXPECT_NEAR(both[1], 100, 25);
    EXPECT_NEAR(both[2], 100, 25);
    EXPECT_EQ(picture(36, 48), cv::Vec4b(220, 30, 30, 255)) << "the square";
}

TEST_F(BakedPainterTest, RecordsTheRigsShares) {
    const std::vector<DepthView> views{coloured_view(-0.5, {0, 0, 200, 255}),
                                       coloured_view(0.5, {0, 200, 0, 255})};
    const auto instant = instant_of(views);
    const DepthPicture& picture = draw(*instant, 0, {views[1].name, views[0].name});
    ASSERT_NE(picture.shares(), nullptr);
    const ColourImage colour = picture.colour().download();
    const ColourImage shares = picture.shares()->download();
    for (int y = 0; y < 10; ++y)
        for (int x = 0; x < drawn_width_px; ++x) {
            EXPECT_NEAR(shares(y, x)[0], 255 * colour(y, x)[1] / 200.0, 2);
            EXPECT_NEAR(shares(y, x)[1], 255 * colour(y, x)[2] / 200.0, 2);
        }
}

/// A measured surface hides inpainted ones, also nearer ones, which are marked in alpha.
TEST_F(BakedPainterTest, PutsInpaintedSurfacesBehindMeasuredOnes) {
    DepthView view = coloured_view(0, {10, 200, 30, 255}, false);
    view.depth_m(cv::Rect(40, 30, 12, 10)) = -4.0f;
    const ColourImage picture = draw(*instant_of({view}), 0).colour().download();
    EXPECT_EQ(picture(35, 46), cv::Vec4b(10, 200, 30, 64));
    EXPECT_EQ(picture(10, 10), cv::Vec4b(10, 200, 30, 255));
}

TEST_F(BakedPainterTest, TakesTheNewestColoursOfARigThatIsThere) {
    DepthView view = coloured_view(0, {10, 200, 30, 255}, false);
    const auto instant = instant_of({view});
    view.colour.setTo(cv::Scalar(90, 80, 70, 255));
    std::unique_ptr<ColourCorrector> corrector;
    std::unique_ptr<DepthUploader> uploader;
    const auto live = std::make_shared<RigSurface>();
    live->upload(view, corrector, uploader);
    instant->colours[0] = live;
    EXPECT_EQ(ColourImage(draw(*instant, 0).colour().download())(36, 48),
              cv::Vec4b(90, 80, 70, 255));
}

}  // namespace
}  // namespace vantage
