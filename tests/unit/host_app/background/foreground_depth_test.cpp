#include "host_app/foreground/foreground_depth.h"

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/gl/context/egl_context.h"
#include "host_app/background/background_model.h"
#include "tests/unit/host_app/fused/wall_and_square.h"

namespace vantage {
namespace {

constexpr int foreground_width_px = 97, foreground_height_px = 73;
constexpr float square_m = 2;

/// Rigs that have learnt a wall, when a square appears before it.
class ForegroundDepthTest : public testing::Test {
  protected:
    static DepthView film(double x_m, bool has_square) {
        DepthView view = wall_and_square(x_m, foreground_width_px, foreground_height_px,
                                         {.square_x_m = has_square ? 0.0 : 100.0});
        view.baseline_m = 0.2;
        return view;
    }
    /// The depth that is found for the first of the rigs, at `x_m` each, which sees `with`.
    DepthImage found(const DepthView& with, std::vector<double> others_x_m) {
        rigs_.clear();
        others_x_m.insert(others_x_m.begin(), 0.0);
        for (const double x_m : others_x_m) {
            RigHistory& rig = *rigs_.emplace_back(std::make_unique<RigHistory>());
            for (int i = 0; i < 5; ++i) see(rig, film(x_m, false));
            see(rig, x_m == 0 ? with : film(x_m, true));
        }
        std::vector<RigHistory*> all;
        for (const auto& rig : rigs_) all.push_back(rig.get());
        return found(*rigs_[0], all);
    }
    DepthImage found(RigHistory& rig, std::span<RigHistory* const> all) {
        rig.foreground_depth().resize(rig.depth().size());
        performers_.find(rig, all, rig.foreground_depth().target());
        return rig.foreground_depth().texture().download();
    }
    void see(RigHistory& rig, const DepthView& view) {
        rig.upload(view, 0.2);
        learner_.learn(rig);
    }
    /// The square's pixels, and all that are farther from it than its matte's soft edge.
    static cv::Mat1b square() {
        const cv::Mat1b inside = film(0, true).depth_m < 3;
        return inside;
    }
    static cv::Mat1b away(int by_px = 3) {
        cv::Mat1b wide;
        cv::dilate(square(), wide, cv::Mat1b::ones(2 * by_px + 1, 2 * by_px + 1));
        return ~wide;
    }

    EglContext context_;
    ShaderLibrary shaders_;
    BackgroundModel learner_{shaders_};
    ForegroundDepth performers_{shaders_};
    std::vector<std::unique_ptr<RigHistory>> rigs_;
};

TEST_F(ForegroundDepthTest, IsTheMeasuredDepthOfTheForegroundAlone) {
    const DepthImage depth_m = found(film(0, true), {0.4});
    EXPECT_LT(cv::norm(depth_m, DepthImage(depth_m.size(), square_m), cv::NORM_INF, square()),
              1e-4);
    EXPECT_LE(cv::norm(cv::max(depth_m, 0), cv::NORM_INF, away()), 0);
}

/// The matte limits the foreground, not its depth.
TEST_F(ForegroundDepthTest, ContinuesBeyondTheMatteForAFewPixels) {
    const DepthImage depth_m = found(film(0, true), {0.4});
    const cv::Mat1b beside = away(1) & ~away(3);
    EXPECT_LT(
        cv::norm(cv::abs(depth_m), DepthImage(depth_m.size(), square_m), cv::NORM_INF, beside),
        1e-4);
    EXPECT_LT(cv::mean(depth_m, away(3) & ~away(5))[0], 0);
    EXPECT_EQ(cv::norm(depth_m, cv::NORM_INF, away(9)), 0);
}

/// A place that another rig sees to be empty: at 3 m the square's left part would show beside its
/// silhouette in the other picture, 0.4 m * 78 px * (1 / 2 m - 1 / 3 m) = 5 px from where it is.
TEST_F(ForegroundDepthTest, LiesWithinTheSilhouettesOfOtherRigs) {
    DepthView wrong = film(0, true);
    cv::Mat1b edge = square();
    const cv::Rect box = cv::boundingRect(edge);
    const cv::Rect strip(box.x, box.y + 4, 3, box.height - 8);
    wrong.depth_m(strip) = 3.0f;
    // Alone a rig has to believe it; beside another it takes what looks like it.
    EXPECT_GT(cv::mean(found(wrong, {})(strip))[0], 2.9);
    const DepthImage carved = found(wrong, {-0.4});
    EXPECT_LT(cv::norm(carved(strip), DepthImage(strip.size(), square_m), cv::NORM_INF), 1e-3)
        << carved(strip);
    // The one on the other side sees the place before the square.
    EXPECT_GT(cv::mean(found(wrong, {0.4})(strip))[0], 2.9);
}

/// All of the square is measured at 2.16 m: from aside, by 1 m * 78 px * (1 / 2 m - 1 / 2.16 m) = 3
/// px, its left edge would show beside its silhouette, and nothing near it tells better.
TEST_F(ForegroundDepthTest, MovesToTheNearestDepthWithinTheSilhouettes) {
    DepthView wrong = film(0, true);
    constexpr float wrong_m = 2.16f;
    wrong.depth_m.setTo(wrong_m, square());
    const cv::Rect box = cv::boundingRect(square());
    const cv::Rect edge(box.x, box.y + 4, 1, box.height - 8), middle(box.x + 8, edge.y, 5, 5);
    EXPECT_NEAR(cv::mean(found(wrong, {})(edge))[0], wrong_m, 1e-3);
    const DepthImage carved = found(wrong, {-1.0, -0.9});
    EXPECT_NEAR(cv::mean(carved(middle))[0], wrong_m, 1e-3);
    EXPECT_LT(cv::mean(carved(edge))[0], 2.13) << carved(edge);
    // A single other rig may have no silhouette there for another reason.
    EXPECT_NEAR(cv::mean(found(wrong, {-1.0})(edge))[0], wrong_m, 1e-3);
}

/// In its first instant a rig cannot separate foreground, so an empty matte means nothing.
TEST_F(ForegroundDepthTest, IgnoresTheSilhouetteOfARigThatHasJustAppeared) {
    (void)found(film(0, true), {0.4});
    RigHistory& other = *rigs_[1];
    other.forget();
    see(other, film(0.4, true));
    RigHistory* const all[] = {rigs_[0].get(), &other};
    const DepthImage depth_m = found(*rigs_[0], all);
    EXPECT_LT(cv::norm(depth_m, DepthImage(depth_m.size(), square_m), cv::NORM_INF, square()),
              1e-4);
}

TEST_F(ForegroundDepthTest, IsInpaintedFromTheNearestPixels) {
    DepthView torn = film(0, true);
    const cv::Rect hole(44, 30, 5, 9);
    torn.depth_m(hole) = 0.0f;
    const DepthImage whole = found(torn, {0.4});
    EXPECT_LT(cv::norm(whole(hole), DepthImage(hole.size(), square_m), cv::NORM_INF), 1e-4);
}

/// What another rig takes away leaves a hole that is too wide for its edges: 1 m * 78 px * (1 / 2 m
/// - 1 / 3 m) = 13 px.
TEST_F(ForegroundDepthTest, IsInpaintedFromAfarIfAnotherRigSeesForegroundThere) {
    DepthView wrong = film(0, true);
    const cv::Rect box = cv::boundingRect(square());
    const cv::Rect strip(box.x, box.y, 12, box.height);
    wrong.depth_m(strip) = 3.0f;
    EXPECT_GT(cv::mean(found(wrong, {})(strip))[0], 2.9);
    const DepthImage whole = found(wrong, {-1.0});
    EXPECT_LT(cv::norm(whole(strip), DepthImage(strip.size(), square_m), cv::NORM_INF), 1e-3)
        << whole(strip);
}

/// A plain surface has depth at its edges only.
TEST_F(ForegroundDepthTest, IsInpaintedFromAfarIfNoOtherRigContradicts) {
    DepthView torn = film(0, true);
    const cv::Rect box = cv::boundingRect(square());
    const cv::Rect hole(box.x + 4, box.y + 4, box.width - 8, box.height - 8);
    ASSERT_GT(std::min(hole.width, hole.height), 13) << "wider than the neighbourhood";
    torn.depth_m(hole) = 0.0f;
    const DepthImage whole = found(torn, {});
    EXPECT_LT(cv::norm(whole(hole), DepthImage(hole.size(), square_m), cv::NORM_INF), 1e-3);
}

TEST_F(ForegroundDepthTest, IsSmoothedWithinASurface) {
    DepthView rough = film(0, true);
    cv::RNG random(3);
    for (float& z : rough.depth_m)
        if (z < 3) z = square_m * static_cast<float>(1 + random.uniform(-0.008, 0.008));
    const auto roughness = [&](const DepthImage& depth_m) {
        return cv::norm(depth_m, DepthImage(depth_m.size(), square_m), cv::NORM_L2, square());
    };
    EXPECT_LT(roughness(found(rough, {0.4})), 0.8 * roughness(rough.depth_m));
}

}  // namespace
}  // namespace vantage
