#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "host_app/gallery/layered_preparer.h"

namespace vantage {
namespace {

constexpr int width_px = 32, height_px = 9, edge_px = 16;
constexpr float near_m = 2, far_m = 4;
const cv::Vec4b red(210, 30, 30, 255), blue(30, 60, 200, 255);

/// The share of a column that lens and sensor fill with what stands left of the edge: a Gauss
/// function's of 0.65 px.
double share_of_near(int x) {
    double near = 0, all = 0;
    for (int u = x - 6; u <= x + 6; ++u) {
        const double w = std::exp(-(u - x) * (u - x) / (2 * 0.65 * 0.65));
        all += w;
        near += u < edge_px ? w : 0;
    }
    return near / all;
}

cv::Vec4b mixed(double share) {
    cv::Vec4b colour;
    for (int c = 0; c < 4; ++c)
        colour[c] = cv::saturate_cast<uchar>(share * red[c] + (1 - share) * blue[c]);
    return colour;
}

double furthest(const cv::Vec4b& a, const cv::Vec4b& b) {
    double most = 0;
    for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(1.0 * a[c] - b[c]));
    return most;
}

/// A red surface left of an edge before a blue one, mixed as a camera does.
class LayerSplitterTest : public testing::Test {
  protected:
    LayerSplitterTest() {
        DepthView view;
        view.K << width_px, 0, 15.5, 0, width_px, 4, 0, 0, 1;
        view.colour = ColourImage(height_px, width_px);
        view.depth_m = DepthImage(height_px, width_px, far_m);
        view.depth_m.colRange(0, edge_px) = near_m;
        for (int x = 0; x < width_px; ++x)
            view.colour.col(x).setTo(cv::Scalar(mixed(share_of_near(x))));
        std::unique_ptr<ColourCorrector> corrector;
        std::unique_ptr<DepthUploader> uploader;
        source_.upload(view, corrector, uploader);
        picture_ = view.colour;
        splitter_.split(source_, main_, boundary_);
    }

    EglContext context_;
    ShaderLibrary shaders_;
    LayerSplitter splitter_{shaders_};
    RigSurface source_, main_, boundary_;
    ColourImage picture_;
};

TEST_F(LayerSplitterTest, ContinuesTheFarSurfaceBehindTheEdgeInTheMainLayer) {
    const DepthImage depth_m = main_.depth().download();
    const ColourImage colour = main_.colour().download();
    for (int x = 0; x < width_px; ++x) {
        // A pixel of the near surface at the edge belongs to the boundary layer.
        EXPECT_EQ(depth_m(4, x), x < edge_px - 1 ? near_m : far_m) << x;
        // What the near surface has of a pixel is taken out, wholly from a share of 0.4 on; 4 of
        // 255, since the pure colours are means over what is nearly pure.
        const double share = share_of_near(x), way = std::min(share / 0.4, 1.0);
        const double left = share * (1 - way * way * (3 - 2 * way));
        const bool is_strip = std::abs(x - edge_px + 0.5) < 1;
        // What is behind the near surface is guessed, and says so.
        EXPECT_NEAR(colour(4, x)[3], is_strip ? 255 * std::max(1 - share, 0.02) : 255, 3) << x;
        EXPECT_LE(furthest(colour(4, x), is_strip ? mixed(left) : picture_(4, x)), is_strip ? 4 : 0)
            << x;
    }
}

TEST_F(LayerSplitterTest, CutsTheNearSurfacesEdgeOutWithAMatte) {
    const DepthImage depth_m = boundary_.depth().download();
    const ColourImage colour = boundary_.colour().download();
    for (int x = 0; x < width_px; ++x) {
        const bool is_strip = x >= edge_px - 2 && x < edge_px + 1;
        EXPECT_EQ(depth_m(4, x), is_strip ? near_m : 0.0f) << x;
        // 2 of 255 for the picture's rounding.
        EXPECT_NEAR(colour(4, x)[3], is_strip ? 255 * share_of_near(x) : 0, 3) << x;
        // What lies behind is taken out where it has a share that shows.
        if (is_strip && share_of_near(x) < 0.6) {
            EXPECT_LE(furthest(colour(4, x), red), 4) << x;
        }
    }
}

}  // namespace
}  // namespace vantage
