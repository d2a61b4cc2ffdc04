#include "host_app/background/background_model.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "common/gl/context/egl_context.h"
#include "common/virtual_stage/virtual_rig.h"
#include "tests/support/deviation_along_time.h"
#include "tests/unit/host_app/fused/wall_and_square.h"

namespace vantage {
namespace {

/// A rig with five instants per second.
class BackgroundModelTest : public testing::Test {
  protected:
    static constexpr int width_px = 81, height_px = 59;
    static constexpr float wall_m = 4, square_m = 2;
    static constexpr double dt_s = 0.2;
    const cv::Rect strip{4, 20, 5, 20};

    struct Learnt {
        DepthImage depth_m;
        ColourImage colour;
        cv::Mat1b matte;
    };
    Learnt next(const DepthView& view) {
        rig_.upload(view, dt_s);
        learner_.learn(rig_);
        Learnt learnt;
        const cv::Mat state = rig_.steady_depth().download();
        cv::extractChannel(state, learnt.depth_m, 0);
        learnt.colour = rig_.colour().download();
        const cv::Mat matte = rig_.matte().texture().download();
        cv::extractChannel(matte, learnt.matte, 0);
        return learnt;
    }
    DepthView film(float strip_m = wall_m, double square_x_m = 0) const {
        DepthView view = wall_and_square(0, width_px, height_px, {.square_x_m = square_x_m});
        view.baseline_m = 0.2;
        view.depth_m(strip) = strip_m;
        return view;
    }
    /// The wall without the square.
    static DepthView empty_stage() {
        DepthView view = wall_and_square(0, width_px, height_px, {.square_x_m = 100});
        view.baseline_m = 0.2;
        return view;
    }
    DepthView filmed_with_noise(double sigma = 2) {
        DepthView view = film();
        add_sensor_noise(view.colour, {.sigma = sigma}, 0, instant_++);
        return view;
    }
    static double furthest(const DepthImage& depth_m, float from_m) {
        return cv::norm(depth_m, DepthImage(depth_m.size(), from_m), cv::NORM_INF);
    }
    /// The largest difference of red, green or blue.
    static double cost(const cv::Mat& a, const cv::Mat& b) {
        cv::Mat off;
        cv::absdiff(a, b, off);
        return cv::norm(off & cv::Scalar(255, 255, 255, 0), cv::NORM_INF);
    }
    /// The pixels of the square in a view.
    static cv::Mat1b square_of(const DepthView& view) { return view.depth_m < 3; }

    EglContext context_;
    ShaderLibrary shaders_;
    BackgroundModel learner_{shaders_};
    RigHistory rig_;
    std::uint64_t instant_ = 0;
};

TEST_F(BackgroundModelTest, AveragesDepthThatStaysWithinItsUncertainty) {
    (void)next(film());
    const DepthImage steady = next(film(1.01f * wall_m)).depth_m(strip);
    EXPECT_GT(steady(2, 2), wall_m);
    EXPECT_LT(steady(2, 2), 1.006f * wall_m);
}

TEST_F(BackgroundModelTest, KeepsItsDepthWhereOnlyTheMatcherAlternates) {
    for (int i = 0; i < 4; ++i) (void)next(film());
    // The matcher assigns a strip beside the square to the square in three of four instants.
    for (int i = 0; i < 30; ++i)
        EXPECT_LT(furthest(next(film(i % 4 == 0 ? wall_m : square_m)).depth_m(strip), wall_m), 1e-3)
            << i;
}

TEST_F(BackgroundModelTest, FollowsADepthThatStaysChanged) {
    for (int i = 0; i < 20; ++i) (void)next(film());
    for (int i = 0; i < 4; ++i)
        EXPECT_LT(furthest(next(film(square_m)).depth_m(strip), wall_m), 1e-3) << i;
    EXPECT_LT(furthest(next(film(square_m)).depth_m(strip), square_m), 1e-3);
}

TEST_F(BackgroundModelTest, RemovesNoiseFromAStillPicture) {
    std::vector<ColourImage> noisy, steady;
    for (int i = 0; i < 24; ++i) {
        const DepthView view = filmed_with_noise();
        const ColourImage mean = next(view).colour;
        if (i < 12) continue;
        noisy.push_back(view.colour);
        steady.push_back(mean);
    }
    const cv::Mat1b everywhere(height_px, width_px, uchar{255});
    EXPECT_LT(deviation_along_time(steady, everywhere),
              0.5 * deviation_along_time(noisy, everywhere));
}

TEST_F(BackgroundModelTest, HardlyEverChangesAPixelOfAStillPicture) {
    for (int i = 0; i < 24; ++i) (void)next(filmed_with_noise(1));
    const ColourImage before = next(filmed_with_noise(1)).colour;
    cv::Mat1b has_changed;
    cv::extractChannel(cv::Mat(next(filmed_with_noise(1)).colour != before), has_changed, 1);
    EXPECT_LT(cv::countNonZero(has_changed), 0.02 * static_cast<double>(has_changed.total()));
}

/// Each step is smaller than the noise.
TEST_F(BackgroundModelTest, FollowsALampThatIsDimmedSlowly) {
    DepthView dimmed = film();
    ColourImage shown;
    for (int i = 0; i < 60; ++i) {
        dimmed.colour = ColourImage(film().colour - cv::Scalar(i, i, i, 0));
        shown = next(dimmed).colour;
    }
    EXPECT_LT(cost(shown, dimmed.colour), 8);
}

TEST_F(BackgroundModelTest, RemembersTheBackgroundBehindForeground) {
    const DepthView empty = empty_stage();
    for (int i = 0; i < 5; ++i) (void)next(empty);
    for (int i = 0; i < 4; ++i) {
        const Learnt learnt = next(film(wall_m, 0.1 * i));
        EXPECT_LT(furthest(learnt.depth_m, wall_m), 0.01) << i;
        EXPECT_LT(cost(learnt.colour, empty.colour), 12) << i;
    }
}

TEST_F(BackgroundModelTest, DrawsAMatteThatIsExactToAPixel) {
    for (int i = 0; i < 5; ++i) (void)next(empty_stage());
    const DepthView with = film();
    const cv::Mat1b matte = next(with).matte >= 128, square = square_of(with);
    cv::Mat1b wide, narrow;
    const cv::Mat around = cv::Mat1b::ones(3, 3);
    cv::dilate(square, wide, around);
    cv::erode(square, narrow, around);
    EXPECT_EQ(cv::countNonZero(narrow & ~matte), 0);
    EXPECT_EQ(cv::countNonZero(matte & ~wide), 0);
}

TEST_F(BackgroundModelTest, DoesNotAbsorbForegroundThatStandsStillForHalfAMinute) {
    for (int i = 0; i < 5; ++i) (void)next(empty_stage());
    Learnt learnt;
    for (double s = 0; s < 30; s += dt_s) learnt = next(film());
    EXPECT_LT(furthest(learnt.depth_m, wall_m), 0.01);
    EXPECT_GT(cv::countNonZero(learnt.matte), 0);
}

TEST_F(BackgroundModelTest, LeavesNoGhostOfForegroundThatStoodThereFromTheStart) {
    for (int i = 0; i < 10; ++i) (void)next(film());
    const DepthView empty = empty_stage();
    // The uncovered wall is not background before it is accepted.
    Learnt learnt = next(empty);
    EXPECT_EQ(cv::countNonZero(square_of(film()) & (learnt.matte < 128)), 0);
    for (int i = 0; i < 2; ++i) learnt = next(empty);
    EXPECT_LT(furthest(learnt.depth_m, wall_m), 0.01);
    EXPECT_LT(cost(learnt.colour, empty.colour), 6);
    EXPECT_EQ(cv::countNonZero(learnt.matte), 0);
}

TEST_F(BackgroundModelTest, TreatsAShadowAsBackground) {
    const DepthView empty = empty_stage();
    for (int i = 0; i < 5; ++i) (void)next(empty);
    DepthView shaded = empty;
    const cv::Rect shadow(20, 20, 30, 20);
    cv::Mat part = shaded.colour(shadow);
    part.convertTo(part, -1, 0.6);
    const Learnt learnt = next(shaded);
    EXPECT_EQ(cv::countNonZero(learnt.matte), 0);
    const cv::Rect within(24, 24, 22, 12);
    EXPECT_LT(cost(learnt.colour(within), shaded.colour(within)), 8);
}

TEST_F(BackgroundModelTest, ContinuesAfterAnInstantThatWasNotLearnt) {
    for (int i = 0; i < 12; ++i) (void)next(filmed_with_noise());
    rig_.upload(film(), dt_s);  // not learnt
    const DepthView view = filmed_with_noise();
    EXPECT_GT(cost(next(view).colour, view.colour), 0) << "a mean";
}

}  // namespace
}  // namespace vantage
