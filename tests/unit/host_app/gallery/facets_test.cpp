#include <gtest/gtest.h>

#include "host_app/view_sets/image_metrics.h"
#include "tests/unit/host_app/gallery/gallery_rendering.h"
#include "tests/unit/host_app/gallery/gallery_scene.h"

namespace vantage {
namespace {

using FacetsTest = GalleryRendering;

TEST_F(FacetsTest, MeetTheTruthBetweenTwoRigs) {
    const DepthView views[] = {ball_and_wall(-12, {161, 121}, true),
                               ball_and_wall(12, {161, 121}, true)};
    const DepthView truth = ball_and_wall(1, {161, 121}, true);
    const ColourImage picture = render("facets", views, view_of_scene(truth));
    EXPECT_GT(psnr_db(picture, truth.colour, covered_mask(picture)), 26);
    EXPECT_GT(coverage(picture), 0.9);
    const Outline seen = red_outline(picture), wanted = red_outline(truth.colour);
    EXPECT_NEAR(seen.middle.x, wanted.middle.x, 1);
    EXPECT_NEAR(seen.area, wanted.area, 0.06 * wanted.area);
}

/// Textures are clipped by depth: squares are larger than their voxels, outlines are not.
TEST_F(FacetsTest, KeepOutlinesHoweverLargeTheirVoxels) {
    const DepthView view = ball_and_wall(0, {161, 121}, true);
    const double wanted = red_outline(view.colour).area;
    for (const char* name : {"facets:voxel-px=1", "facets:voxel-px=3", "facets:voxel-px=8"})
        EXPECT_NEAR(red_outline(render(name, {&view, 1}, view_of_scene(view))).area, wanted,
                    0.03 * wanted)
            << name;
}

TEST_F(FacetsTest, ErrTheMoreTheLargerTheirVoxels) {
    const DepthView view = ball_and_wall(0, {161, 121}, true);
    const DepthView truth = ball_and_wall(15, {161, 121}, true);
    const auto error = [&](const char* name) {
        const ColourImage picture = render(name, {&view, 1}, view_of_scene(truth));
        return mean_error(picture, truth.colour, covered_mask(picture));
    };
    EXPECT_GT(error("facets:voxel-px=12"), 1.3 * error("facets:voxel-px=2"));
}

}  // namespace
}  // namespace vantage
