#include "host_app/fused/fused_colour.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "tests/support/filled_texture.h"
#include "tests/unit/host_app/fused/drawn_surfaces.h"

namespace vantage {
namespace {

const cv::Size wall_size_px(49, 37);
constexpr float wall_m = 2;
const cv::Vec4b red(200, 20, 20, 255), blue(20, 20, 200, 255), green(20, 200, 20, 255);
const cv::Point middle(24, 18);

/// One rig's word for a point `wall_m` ahead of the virtual camera.
double closeness(double x_m) { return 1 / (1 - wall_m / std::hypot(x_m, wall_m) + 1e-5); }

cv::Vec4b mixed(const cv::Vec4b& a, double share, const cv::Vec4b& b) {
    cv::Vec4b colour;
    for (int c = 0; c < 4; ++c)
        colour[c] = cv::saturate_cast<uchar>(share * a[c] + (1 - share) * b[c]);
    return colour;
}

double furthest(const cv::Vec4b& a, const cv::Vec4b& b) {
    double most = 0;
    for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(1.0 * a[c] - b[c]));
    return most;
}

/// Rigs along x before a wall, and a virtual camera at 0 that knows the depth of its pixels.
class FusedColourTest : public testing::Test {
  protected:
    FusedColourTest() : found_m_(wall_size_px, wall_m) {}

    DepthView& add(double x_m, const cv::Vec4b& colour) {
        return views_.emplace_back(plain_wall(x_m, wall_size_px, wall_m, colour));
    }
    struct Drawn {
        ColourImage colour;
        DepthImage depth_m;
        ColourImage shares;
    };
    Drawn draw(bool plainly = false, float first_presence = 1) {
        DrawnSurfaces surfaces(shaders_);
        for (const DepthView& view : views_) surfaces.add(view);
        std::vector<DrawnLayer> drawn = surfaces.layers();
        drawn[0].presence = first_presence;
        layers_.draw(drawn, camera_of(plain_wall(0, wall_size_px, wall_m, {})));
        const Texture found = filled_texture(TextureFormat::r32f, found_m_);
        DepthPicture picture;
        if (plainly) {
            picture.resize(wall_size_px, true);
            fused_.draw_plainly(layers_, found, picture, true);
        } else {
            picture.resize(wall_size_px, true, &fused_.sort(found));
            fused_.draw(layers_, found, picture, true);
        }
        return {picture.colour().download(), picture.depth_m().download(),
                picture.shares()->download()};
    }

    EglContext context_;
    ShaderLibrary shaders_;
    FusedColour fused_{shaders_};
    RigLayers layers_{shaders_};
    std::vector<DepthView> views_;
    DepthImage found_m_;
};

TEST_F(FusedColourTest, MixesTheRigsByTheAngleOfTheirLinesOfSight) {
    add(-0.2, red);
    add(0.3, blue);
    const double share = closeness(-0.2) / (closeness(-0.2) + closeness(0.3));
    for (const bool plainly : {false, true}) {
        const Drawn drawn = draw(plainly);
        EXPECT_LE(furthest(drawn.colour(middle), mixed(red, share, blue)), 1) << plainly;
        EXPECT_NEAR(drawn.shares(middle)[0], 255 * share, 1);
        EXPECT_NEAR(drawn.shares(middle)[1], 255 * (1 - share), 1);
        EXPECT_EQ(drawn.depth_m(middle), wall_m);
    }
}

TEST_F(FusedColourTest, WeighsRigsByTheirConfidenceAndPresence) {
    add(-0.2, red).colour.setTo(cv::Scalar(200, 20, 20, 64));
    add(0.2, blue);
    const double confidence = 64 / 255.0;
    EXPECT_LE(furthest(draw().colour(middle), mixed(red, confidence / (1 + confidence), blue)), 1);
    EXPECT_LE(furthest(draw(false, 0.5f).colour(middle),
                       mixed(red, 0.5 * confidence / (1 + 0.5 * confidence), blue)),
              1);
    EXPECT_LE(furthest(draw(true, 0.5f).colour(middle),
                       mixed(red, 0.5 * confidence / (1 + 0.5 * confidence), blue)),
              1);
}

TEST_F(FusedColourTest, SamplesOnlyRigsWhoseOwnDepthHasTheSurface) {
    add(-0.2, red).depth_m.setTo(1.8f);
    add(0.3, blue);
    EXPECT_LE(furthest(draw().colour(middle), blue), 1);
    EXPECT_LE(furthest(draw(true).colour(middle), blue), 1);
    // Nobody has it.
    views_[1].depth_m.setTo(3.0f);
    EXPECT_EQ(draw().colour(middle), cv::Vec4b(0, 0, 0, 0));
    EXPECT_EQ(draw(true).colour(middle), cv::Vec4b(0, 0, 0, 0));
}

TEST_F(FusedColourTest, IgnoresAThirdRigWhereOneOfTheFirstTwoSeesWell) {
    add(-0.2, red);
    add(0.2, red);
    add(0.6, green);
    EXPECT_LE(furthest(draw().colour(middle), red), 1);
    // They see nothing of it.
    views_[0].depth_m.setTo(1.5f);
    views_[1].depth_m.setTo(1.5f);
    EXPECT_LE(furthest(draw().colour(middle), green), 1);
    // Within a picture, pixels of either kind stand beside each other.
    views_[0].depth_m.setTo(wall_m);
    views_[1].depth_m.setTo(wall_m);
    for (std::size_t i = 0; i < 2; ++i) views_[i].depth_m.rowRange(0, 10) = 1.5f;
    const ColourImage both = draw().colour;
    EXPECT_LE(furthest(both(4, 24), green), 1);
    EXPECT_LE(furthest(both(28, 24), red), 1);
}

TEST_F(FusedColourTest, DoesNotClaimInpaintedSurfaces) {
    add(-0.2, red).depth_m.setTo(-wall_m);
    found_m_.setTo(-wall_m);
    for (const bool plainly : {false, true}) {
        const cv::Vec4b inpainted = draw(plainly).colour(middle);
        EXPECT_EQ(inpainted[3], 64);
        EXPECT_LE(furthest(inpainted, red), 1);
    }
}

/// A red square before a blue wall, from where the only rig is: away from the edge the pixels are
/// the rig's, and beside it no colour comes up that neither surface has.
TEST_F(FusedColourTest, KeepsBothSurfacesApartAtADepthEdge) {
    DepthView& only = add(0, blue);
    const cv::Rect square(18, 12, 14, 12);
    only.depth_m.setTo(4.0f);
    only.depth_m(square) = 2.0f;
    only.colour(square) = red;
    only.depth_m.copyTo(found_m_);
    const Drawn drawn = draw();
    for (int y = 4; y < wall_size_px.height - 4; ++y)
        for (int x = 4; x < wall_size_px.width - 4; ++x) {
            const bool is_red = square.contains({x, y});
            const cv::Vec4b& c = drawn.colour(y, x);
            // 3 of 255: cubic interpolation of 8 bits.
            EXPECT_LE(furthest(c, is_red ? red : blue), 3) << x << ' ' << y;
            EXPECT_EQ(drawn.depth_m(y, x), is_red ? 2.0f : 4.0f);
        }
}

/// As lens and sensor would, where rigs show what is on either side.
TEST_F(FusedColourTest, SoftensADepthEdgeByAPixel) {
    found_m_.setTo(4.0f);
    found_m_.colRange(0, 20) = 2.0f;
    // So far aside that the near surface is two pixels from its place.
    const double aside_m = 4.0 / wall_size_px.width;
    DepthView& sees_edge = add(-aside_m, blue);
    sees_edge.depth_m.setTo(4.0f);
    sees_edge.depth_m.colRange(0, 22) = 2.0f;
    sees_edge.colour.colRange(0, 22) = red;
    add(aside_m, blue).depth_m.setTo(4.0f);
    const ColourImage colour = draw().colour;
    EXPECT_GT(furthest(colour(18, 19), red), 10);
    EXPECT_GT(furthest(colour(18, 19), blue), 10);
    EXPECT_LE(furthest(colour(18, 16), red), 1);
    EXPECT_LE(furthest(colour(18, 23), blue), 1);
}

/// Where nothing was drawn beside an edge only the surface behind reaches in.
TEST_F(FusedColourTest, LeavesHolesEmptyButForTheirFarEdge) {
    DepthView& only = add(0, blue);
    only.depth_m.setTo(4.0f);
    only.depth_m.colRange(0, 20) = 2.0f;
    only.colour.colRange(0, 20) = red;
    only.depth_m.copyTo(found_m_);
    found_m_.colRange(20, 30) = 0.0f;
    const ColourImage colour = draw().colour;
    for (int x = 22; x < 28; ++x) EXPECT_EQ(colour(18, x), cv::Vec4b(0, 0, 0, 0)) << x;
    for (const int x : {20, 21})
        EXPECT_EQ(colour(18, x)[3], 0) << x << ": the near surface does not grow";
}

}  // namespace
}  // namespace vantage
