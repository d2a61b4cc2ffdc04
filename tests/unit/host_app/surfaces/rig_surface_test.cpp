#include "host_app/surfaces/rig_surface.h"

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"

namespace vantage {
namespace {

class RigSurfaceTest : public testing::Test {
  protected:
    void begin(RigSurface& surface) {
        surface.begin(camera_, cv::Size(8, 6), cv::Size(8, 6), SurfaceSamples());
    }

    EglContext context_;
    DepthView camera_;
};

/// Buffers are as large as a depth map can need, and slower to allocate than to fill.
TEST_F(RigSurfaceTest, StartedAgainReusesAReleasedShape) {
    const auto shapes = std::make_shared<RigSurface::Shapes>();
    RigSurface before(shapes), now(shapes);
    begin(before);
    begin(now);
    const IndirectTriangles* let_go = &now.triangles();
    now.begin_like(before, SurfaceSamples());
    EXPECT_EQ(&now.triangles(), &before.triangles());
    begin(before);
    EXPECT_EQ(&before.triangles(), let_go);
    EXPECT_NE(&now.triangles(), let_go);
}

TEST_F(RigSurfaceTest, StartedAgainLeavesASharedShapeAlone) {
    RigSurface before, now;
    begin(before);
    now.begin_like(before, SurfaceSamples());
    const IndirectTriangles* shown = &now.triangles();
    begin(before);
    EXPECT_NE(&before.triangles(), shown);
    EXPECT_EQ(&now.triangles(), shown);
}

}  // namespace
}  // namespace vantage
