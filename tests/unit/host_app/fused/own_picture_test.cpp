#include "host_app/fused/own_picture.h"

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/view_sets/image_metrics.h"
#include "tests/support/stage_camera_at.h"

namespace vantage {
namespace {

constexpr int own_width_px = 160, own_height_px = 120;

/// Three rigs around the virtual stage, whose depth is wrong by up to an eighth in blocks.
class OwnPictureTest : public testing::TestWithParam<int> {
  protected:
    static VirtualView view_at(double azimuth_deg) {
        const StageCamera camera = camera_at(azimuth_deg, own_width_px, own_height_px);
        return {camera.width_px, camera.height_px, camera.K, camera.world_from_camera};
    }
    std::vector<DepthView> film(int instant) {
        std::vector<DepthView> views;
        for (const double azimuth_deg : {-20.0, 0.0, 20.0}) {
            DepthView& view =
                views.emplace_back(exact_view_at(stage_, azimuth_deg, own_width_px, own_height_px,
                                                 std::chrono::milliseconds(1000 + 200 * instant)));
            constexpr int block_px = 12, kinds = 5;
            for (int y = 0; y < view.depth_m.rows; ++y)
                for (int x = 0; x < view.depth_m.cols; ++x)
                    view.depth_m(y, x) *=
                        1 + 0.0625f *
                                static_cast<float>((x / block_px + 3 * (y / block_px)) % kinds - 2);
        }
        return views;
    }

    EglContext context_;
    ShaderLibrary shaders_;
    VirtualStage stage_{shaders_};
    const SynthesiserEntry fused_ = find_synthesiser("fused");
    std::unique_ptr<InstantPreparer> preparer_ = fused_.make_preparer(shaders_);
    std::unique_ptr<ViewRenderer> renderer_ = fused_.make_renderer(shaders_);
};

TEST_P(OwnPictureTest, PrevailsAtEveryRigsOwnPlaceWhateverTheDepths) {
    const auto rank = static_cast<std::size_t>(GetParam());
    constexpr int instants = 9;
    constexpr double dt_s = 0.2, least_db = 38;
    std::vector<DepthView> views;
    for (int instant = 0; instant < instants; ++instant) {
        views = film(instant);
        preparer_->take(views, dt_s);
        (void)preparer_->prepare(view_at(6), prepare_levels()[rank]);
        preparer_->improve(view_at(6));
    }
    for (std::size_t rig = 0; rig < views.size(); ++rig) {
        const VirtualView place = view_at(-20.0 + 20.0 * static_cast<double>(rig));
        const auto instant = preparer_->prepare(place, prepare_levels()[rank]);
        const ColourImage picture =
            renderer_->render(*instant, place, render_levels()[rank == 0 ? 0 : 3]).download();
        EXPECT_GE(psnr_db(picture, views[rig].colour), least_db) << "rig " << rig;
    }
    // Between the rigs none of them is near.
    const auto instant = preparer_->prepare(view_at(10), prepare_levels()[rank]);
    for (const InstantRig& rig : instant->rigs) EXPECT_EQ(rig.picture, nullptr);
}

INSTANTIATE_TEST_SUITE_P(Levels, OwnPictureTest, testing::Values(0, 2));

TEST_F(OwnPictureTest, CountsInTheSharesOfTheRigs) {
    const std::vector<DepthView> views = film(0);
    preparer_->take(views, 0.2);
    const auto instant = preparer_->prepare(view_at(0), prepare_levels().front());
    ASSERT_TRUE(renderer_->note_origins(true));
    (void)renderer_->render(*instant, view_at(0), render_levels().front());
    const PixelOrigins* origins = renderer_->origins();
    ASSERT_NE(origins, nullptr);
    const cv::Scalar shares = cv::mean(origins->shares->download());
    for (std::size_t rig = 0; rig < origins->rigs.size(); ++rig)
        EXPECT_NEAR(shares[static_cast<int>(rig)], origins->rigs[rig] == views[1].name ? 255 : 0, 3)
            << origins->rigs[rig];
}

}  // namespace
}  // namespace vantage
