#include <thread>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/gl/context/egl_context.h"
#include "common/virtual_stage/virtual_rig.h"
#include "common/virtual_stage/virtual_stage.h"
#include "host_app/baked/background_probe.h"
#include "host_app/fused/staged_preparer.h"
#include "host_app/synthesis/synthesiser.h"
#include "tests/support/stage_camera_at.h"

namespace vantage {
namespace {

constexpr int baked_width_px = 160, baked_height_px = 120;
constexpr double baked_dt_s = 0.25;

double error_of(const ColourImage& picture, const ColourImage& truth) {
    return cv::norm(picture, truth, cv::NORM_L1) / (3.0 * static_cast<double>(picture.total()));
}

/// Three rigs with exact depth around the virtual stage, prepared at a level that draws a baked
/// background.
class BakedBackgroundTest : public testing::Test {
  protected:
    std::vector<DepthView> film(int instant) {
        std::vector<DepthView> views;
        for (const double azimuth_deg : {-20.0, 0.0, 20.0}) {
            DepthView& view = views.emplace_back(
                exact_view_at(stage_, azimuth_deg, baked_width_px, baked_height_px,
                              std::chrono::milliseconds(1000 + 250 * instant)));
            if (!is_rebuilt_) continue;
            cv::bitwise_not(view.colour, view.colour);
            view.depth_m *= 1.25f;
        }
        return views;
    }
    static VirtualView target(double azimuth_deg) {
        const StageCamera camera = camera_at(azimuth_deg, baked_width_px, baked_height_px);
        return {camera.width_px, camera.height_px, camera.K, camera.world_from_camera};
    }
    /// Prepares the next instant, and all that it gives time for.
    std::shared_ptr<const Instant> next(int rank = 2) {
        preparer_.take(film(instant_++), baked_dt_s);
        std::shared_ptr<const Instant> instant = preparer_.prepare(
            target(azimuth_deg_), prepare_levels()[static_cast<std::size_t>(rank)]);
        preparer_.improve(target(azimuth_deg_));
        return instant;
    }
    bool is_baked(const Instant& instant) {
        return dynamic_cast<const BakedExtra*>(instant.extra.get()) != nullptr;
    }
    /// Prepares instants until the background is baked; null if it never is.
    std::shared_ptr<const Instant> baked() {
        constexpr int patience = 24;
        for (int i = 0; i < patience; ++i)
            if (std::shared_ptr<const Instant> instant = next(); is_baked(*instant)) return instant;
        return nullptr;
    }
    ColourImage picture(const Instant& instant) {
        return renderer_->render(instant, target(azimuth_deg_), plain_).download();
    }

    EglContext context_;
    ShaderLibrary shaders_;
    VirtualStage stage_{shaders_};
    StagedPreparer preparer_{shaders_};
    std::unique_ptr<ViewRenderer> renderer_ = find_synthesiser("fused").make_renderer(shaders_);
    const RenderLevel plain_{3, 2, 0, 1, true};
    double azimuth_deg_ = 6;
    int instant_ = 0;
    bool is_rebuilt_ = false;  ///< everything looks different and is farther
};

TEST_F(BakedBackgroundTest, LooksLikeTheSurfacesThatItWasBakedFrom) {
    const std::shared_ptr<const Instant> instant = baked();
    ASSERT_NE(instant, nullptr);
    Instant without = *instant;
    without.extra = nullptr;
    const ColourImage drawn = picture(*instant), again = picture(without);
    const ColourImage truth = stage_
                                  .render(camera_at(azimuth_deg_, baked_width_px, baked_height_px),
                                          std::chrono::milliseconds(1000 + 250 * (instant_ - 1)),
                                          {.pictures = StagePictures::colour})
                                  .colour;
    EXPECT_LT(error_of(drawn, truth), 1.1 * error_of(again, truth));
    EXPECT_LT(error_of(drawn, again), error_of(again, truth));
}

TEST_F(BakedBackgroundTest, NotesWhichRigsAPixelComesFrom) {
    const std::shared_ptr<const Instant> instant = baked();
    ASSERT_NE(instant, nullptr);
    ASSERT_TRUE(renderer_->note_origins(true));
    (void)picture(*instant);
    ASSERT_NE(renderer_->origins(), nullptr);
    const cv::Mat shares = renderer_->origins()->shares->download();
    EXPECT_NEAR(cv::mean(shares)[0] + cv::mean(shares)[1], 255, 20)
        << "the two nearest rigs give nearly every colour";
}

TEST_F(BakedBackgroundTest, IsBakedAnewAfterAChange) {
    ASSERT_NE(baked(), nullptr);
    is_rebuilt_ = true;
    // After the change the old probes are not drawn any more, and the next ones are made in the
    // very instant in which the change is noticed. improve() has to end there too.
    constexpr int most = 24, refined = 1;
    bool has_ended = false;
    for (int i = 0; i < most && !has_ended; ++i) has_ended = !is_baked(*next(refined));
    EXPECT_TRUE(has_ended);
    bool is_back = false;
    for (int i = 0; i < most && !is_back; ++i) is_back = is_baked(*next(refined));
    EXPECT_TRUE(is_back);
}

/// Instants end on any thread; a texture that ends without a context would stay in the driver.
TEST_F(BakedBackgroundTest, EndsOnItsOwnThread) {
    std::shared_ptr<const Instant> instant = baked();
    ASSERT_NE(instant, nullptr);
    const std::weak_ptr<const BackgroundProbe> probe =
        dynamic_cast<const BakedExtra&>(*instant->extra).background.probes.at(0);
    preparer_.background_access()->learn_anew();
    std::thread([&] { instant.reset(); }).join();
    EXPECT_FALSE(probe.expired());
    (void)next();
    EXPECT_TRUE(probe.expired());
}

TEST_F(BakedBackgroundTest, IsNotDrawnAtTheBestLevel) {
    ASSERT_NE(baked(), nullptr);
    EXPECT_FALSE(is_baked(*next(0)));
}

TEST_F(BakedBackgroundTest, WaitsForProbesWhereTheCameraGoes) {
    ASSERT_NE(baked(), nullptr);
    preparer_.background_access()->learn_anew();
    EXPECT_FALSE(is_baked(*next())) << "nothing is known of the background any more";
}

}  // namespace
}  // namespace vantage
