#include "host_app/fused/staged_preparer.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/gl/context/egl_context.h"
#include "tests/unit/host_app/fused/wall_and_square.h"
#include "tests/unit/host_app/refine/pole_before_wall.h"

namespace vantage {
namespace {

constexpr int staged_width_px = 97, staged_height_px = 73;
constexpr float stage_wall_m = 4, stage_square_m = 2;

/// One rig before a wall, which a square stands before at times.
class StagedPreparerTest : public testing::Test {
  protected:
    static DepthView film(bool has_square) {
        DepthView view = wall_and_square(0, staged_width_px, staged_height_px,
                                         {.square_x_m = has_square ? 0.0 : 100.0});
        view.name = "only";
        view.baseline_m = 0.2;
        return view;
    }
    std::shared_ptr<const Instant> prepared(const DepthView& view) {
        preparer_.take({&view, 1}, 0.2);
        return preparer_.prepare(
            {staged_width_px, staged_height_px, view.K, view.world_from_camera},
            prepare_levels().front());
    }
    static cv::Mat1b square(int margin_px) {
        cv::Mat1b inside = film(true).depth_m < 3;
        const cv::Mat around =
            cv::Mat1b::ones(2 * std::abs(margin_px) + 1, 2 * std::abs(margin_px) + 1);
        if (margin_px > 0)
            cv::dilate(inside, inside, around);
        else
            cv::erode(inside, inside, around);
        return inside;
    }
    static double cost(const ColourImage& a, const ColourImage& b, const cv::Mat1b& where) {
        cv::Mat off, part;
        cv::absdiff(a, b, off);
        off.copyTo(part, where);
        return cv::norm(part & cv::Scalar(255, 255, 255, 0), cv::NORM_INF);
    }

    /// How far what a rig has learnt is from the empty stage at worst, metres.
    double learnt_off_m(std::size_t rig = 0) {
        const DepthImage depth_m = preparer_.background_access()->learnt().rigs.at(rig).depth_m;
        return cv::norm(depth_m, DepthImage(depth_m.size(), stage_wall_m), cv::NORM_INF);
    }

    EglContext context_;
    ShaderLibrary shaders_;
    StagedPreparer preparer_{shaders_};
};

TEST_F(StagedPreparerTest, PutsForegroundBeforeTheBackground) {
    for (int i = 0; i < 5; ++i) (void)prepared(film(false));
    const DepthView with = film(true);
    const std::shared_ptr<const Instant> instant = prepared(with);
    ASSERT_EQ(instant->rigs.size(), 1u);
    ASSERT_NE(instant->rigs[0].boundary, nullptr);
    const RigSurface& performers = *instant->rigs[0].boundary;
    const DepthImage depth_m = performers.depth().download();
    // A matte's edge is soft by a pixel.
    EXPECT_LT(
        cv::norm(depth_m, DepthImage(depth_m.size(), stage_square_m), cv::NORM_INF, square(-1)),
        0.01);
    const ColourImage colour = performers.colour().download();
    cv::Mat1b share;
    cv::extractChannel(colour, share, 3);
    EXPECT_EQ(cv::countNonZero((share < 255) & square(-1)), 0);
    EXPECT_EQ(cv::countNonZero(share & ~square(1)), 0);
    EXPECT_LE(cost(colour, with.colour, square(-1)), 1);
    EXPECT_EQ(cv::norm(colour, cv::NORM_INF, ~square(1)), 0);
}

/// The background's share is removed from the colours of pixels at the foreground's edge.
TEST_F(StagedPreparerTest, RemovesTheBackgroundFromColoursAtEdges) {
    for (int i = 0; i < 5; ++i) (void)prepared(film(false));
    DepthView with = film(true);
    const ColourImage behind = film(false).colour;
    const cv::Mat1b edge = square(0) & ~square(-1);
    for (int y = 0; y < edge.rows; ++y)
        for (int x = 0; x < edge.cols; ++x)
            if (edge(y, x)) with.colour(y, x) = 0.5 * with.colour(y, x) + 0.5 * behind(y, x);
    const ColourImage colour = prepared(with)->rigs.at(0).boundary->colour().download();
    int edges = 0;
    for (int y = 0; y < edge.rows; ++y)
        for (int x = 0; x < edge.cols; ++x) {
            if (!edge(y, x)) continue;
            ++edges;
            const cv::Vec4b& seen = colour(y, x);
            ASSERT_NEAR(seen[3], 128, 30) << x << ' ' << y;
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(255.0 * seen[c] / seen[3], film(true).colour(y, x)[c], 25)
                    << x << ' ' << y << " channel " << c;
        }
    EXPECT_GT(edges, 100);
}

/// Depth and triangles are kept for a second after a refinement; colours are new for each instant.
TEST_F(StagedPreparerTest, KeepsTheShapeOfABakedBackground) {
    const DepthView empty = film(false);
    const VirtualView target{staged_width_px, staged_height_px, empty.K, empty.world_from_camera};
    const auto shown = [&](const DepthView& view) {
        preparer_.take({&view, 1}, 0.2);
        return preparer_.prepare(target, prepare_levels().back())->rigs.at(0).surface;
    };
    for (int i = 0; i < 5; ++i) (void)shown(empty);
    preparer_.improve(target);
    const auto first = shown(empty);
    DepthView lit = empty;
    for (cv::Vec4b& c : lit.colour) c = 0.9 * c;
    const auto second = shown(lit);
    EXPECT_EQ(&second->depth(), &first->depth());
    EXPECT_EQ(&second->triangles(QuadGrid::coarse), &first->triangles(QuadGrid::coarse));
    EXPECT_NE(&second->colour(), &first->colour());
}

TEST_F(StagedPreparerTest, KeepsTheBackgroundBehindForeground) {
    const DepthView empty = film(false);
    for (int i = 0; i < 5; ++i) (void)prepared(empty);
    const std::shared_ptr<const Instant> instant = prepared(film(true));
    const RigSurface& set = *instant->rigs.at(0).surface;
    const DepthImage depth_m = set.depth().download();
    const ColourImage colour = set.colour().download();
    EXPECT_LT(cv::norm(depth_m, DepthImage(depth_m.size(), stage_wall_m), cv::NORM_INF), 0.02);
    EXPECT_LE(cost(colour, empty.colour, cv::Mat1b(colour.size(), uchar{255})), 3);
    cv::Mat1b confidence;
    cv::extractChannel(colour, confidence, 3);
    const auto remembered =
        static_cast<uchar>(std::lround(255 * RigSurface::remembered_confidence));
    EXPECT_EQ(cv::countNonZero((confidence != remembered) & square(0)), 0) << "it is not seen now";
    EXPECT_EQ(cv::countNonZero((confidence != 255) & ~square(4)), 0) << "it is";
}

/// Inpainted depth is not part of the learnt background.
TEST_F(StagedPreparerTest, DoesNotLearnInpaintedDepth) {
    DepthView torn = film(false);
    const cv::Rect hole(44, 30, 8, 8);
    torn.depth_m(hole) = 0.0f;
    const auto set_m = [](const Instant& instant) {
        return DepthImage(instant.rigs.at(0).surface->depth().download());
    };
    for (int i = 0; i < 5; ++i) (void)prepared(torn);
    const DepthImage inpainted = set_m(*prepared(torn))(hole);
    EXPECT_LT(cv::norm(inpainted, DepthImage(hole.size(), -stage_wall_m), cv::NORM_INF), 0.01);
    DepthView with = film(true);
    with.depth_m(hole) = 0.0f;
    const DepthImage hidden = set_m(*prepared(with));
    EXPECT_EQ(cv::countNonZero(hidden(hole)), 0);
    EXPECT_EQ(cv::countNonZero(hidden == 0), hole.area());
}

/// Another preparer continues with the background, although a square hides it from the first
/// instant.
TEST_F(StagedPreparerTest, BeginsWithALoadedBackground) {
    const DepthView empty = film(false);
    for (int i = 0; i < 8; ++i) (void)prepared(empty);
    const auto learnt = std::make_shared<const Background>(preparer_.background_access()->learnt());
    ASSERT_EQ(learnt->rigs.size(), 1u);
    EXPECT_EQ(preparer_.background_access()->states().at(0).known, 1);
    EXPECT_FALSE(preparer_.background_access()->states()[0].is_loaded);

    StagedPreparer next(shaders_);
    next.background_access()->begin_with(learnt);
    const DepthView with = film(true);
    next.take({&with, 1}, 0.2);
    const RigBackgroundState state = next.background_access()->states().at(0);
    EXPECT_EQ(state.known, 1);
    EXPECT_TRUE(state.is_loaded);
    EXPECT_EQ(state.misfit, "");
    const std::shared_ptr<const Instant> instant = next.prepare(
        {staged_width_px, staged_height_px, with.K, with.world_from_camera}, prepare_levels()[2]);
    const DepthImage square_m(with.depth_m.size(), stage_square_m);
    EXPECT_LT(cv::norm(DepthImage(instant->rigs.at(0).boundary->depth().download()), square_m,
                       cv::NORM_INF, square(-1)),
              0.01);
    const RigSurface& set = *instant->rigs[0].surface;
    EXPECT_LE(cost(set.colour().download(), empty.colour, square(0)), 3);
    EXPECT_EQ(cv::countNonZero(DepthImage(set.depth().download()) <= 0), 0);
}

TEST_F(StagedPreparerTest, ReportsAReducedMatteForOperators) {
    for (int i = 0; i < 8; ++i) (void)prepared(film(false));
    EXPECT_EQ(cv::countNonZero(preparer_.background_access()->states().at(0).matte > 20), 0);
    // The matte is sampled once per second.
    for (int i = 0; i < 6; ++i) (void)prepared(film(true));
    const cv::Mat1b matte = preparer_.background_access()->states().at(0).matte;
    ASSERT_EQ(matte.size(), cv::Size(staged_width_px, staged_height_px));
    EXPECT_GT(cv::mean(matte, square(-2))[0], 230);
    EXPECT_LT(cv::mean(matte, ~square(4))[0], 5);
}

TEST_F(StagedPreparerTest, ExplainsWhyALoadedBackgroundDoesNotFit) {
    for (int i = 0; i < 8; ++i) (void)prepared(film(false));
    auto learnt = std::make_shared<Background>(preparer_.background_access()->learnt());
    DepthView moved = film(false);
    moved.world_from_camera.translation().x() += 0.01;
    StagedPreparer other_place(shaders_);
    other_place.background_access()->begin_with(learnt);
    other_place.take({&moved, 1}, 0.2);
    RigBackgroundState state = other_place.background_access()->states().at(0);
    EXPECT_FALSE(state.is_loaded);
    EXPECT_NE(state.misfit.find("another calibration or image size of rig only"), std::string::npos)
        << state.misfit;
    EXPECT_EQ(state.known, 0);

    learnt->rigs[0].rig = "another";
    StagedPreparer other_rig(shaders_);
    other_rig.background_access()->begin_with(learnt);
    const DepthView view = film(false);
    other_rig.take({&view, 1}, 0.2);
    state = other_rig.background_access()->states().at(0);
    EXPECT_FALSE(state.is_loaded);
    EXPECT_NE(state.misfit.find("has no rig only"), std::string::npos) << state.misfit;
}

/// Neither a square that stood there from the start nor a loaded background comes back.
TEST_F(StagedPreparerTest, LearnsAnewFromAnEmptyStage) {
    for (int i = 0; i < 8; ++i) (void)prepared(film(true));
    preparer_.background_access()->begin_with(
        std::make_shared<const Background>(preparer_.background_access()->learnt()));
    preparer_.background_access()->learn_anew();
    for (int i = 0; i < 6; ++i) (void)prepared(film(false));
    EXPECT_EQ(preparer_.background_access()->states().at(0).known, 1);
    EXPECT_FALSE(preparer_.background_access()->states()[0].is_loaded);
    const RigBackground set = preparer_.background_access()->learnt().rigs.at(0);
    EXPECT_LT(cv::norm(set.depth_m, DepthImage(set.depth_m.size(), stage_wall_m), cv::NORM_INF),
              0.02);
    preparer_.cut();
    (void)prepared(film(false));
    EXPECT_FALSE(preparer_.background_access()->states().at(0).is_loaded);
}

/// After a cut the picture has priority: a rig that is not in it learns from the next instant on.
TEST_F(StagedPreparerTest, PostponesRigsThatAreNotShownAfterACut) {
    std::vector<DepthView> views{film(false), film(false)};
    views[1].name = "other";
    const VirtualView target{staged_width_px, staged_height_px, views[0].K,
                             views[0].world_from_camera};
    const PrepareLevel one_rig{3, 1, false, false};
    const auto learnt = [&] { return preparer_.background_access()->learnt().rigs.size(); };
    const auto show = [&](const PrepareLevel& level) {
        return preparer_.prepare(target, level)->rigs.size();
    };
    preparer_.cut();
    preparer_.take(views, 0.2);
    EXPECT_EQ(learnt(), 0u);
    EXPECT_EQ(show(one_rig), 1u);
    EXPECT_EQ(learnt(), 1u);
    EXPECT_EQ(show(prepare_levels().front()), 2u) << "refinement needs all rigs";
    EXPECT_EQ(learnt(), 2u);
    for (DepthView& view : views) view.world_from_camera.translation().y() += 0.1;
    preparer_.take(views, 0.2);
    EXPECT_EQ(learnt(), 2u) << "other places without a cut";
    for (DepthView& view : views) view.world_from_camera.translation().y() += 0.1;
    preparer_.cut();
    preparer_.take(views, 0.2);
    (void)show(one_rig);
    EXPECT_EQ(learnt(), 1u);
    preparer_.take(views, 0.2);
    EXPECT_EQ(learnt(), 2u) << "every rig learns in the end";
}

/// If there is time for two rigs only, the others take turns.
TEST_F(StagedPreparerTest, LearnsRigsThatAreNotShownInTurnAtTheCheapestLevel) {
    std::vector<DepthView> views(4, film(false));
    for (std::size_t i = 0; i < views.size(); ++i) views[i].name = std::to_string(i);
    const VirtualView target{staged_width_px, staged_height_px, views[0].K,
                             views[0].world_from_camera};
    const PrepareLevel one_rig{3, 1, false, false};
    // The certainty of the wall grows with every instant that is learnt.
    const auto certainties = [&] {
        std::vector<double> all;
        for (const RigBackground& rig : preparer_.background_access()->learnt().rigs)
            all.push_back(cv::mean(rig.certainty)[0]);
        return all;
    };
    const auto take = [&] {
        preparer_.take(views, 0.2);
        (void)preparer_.prepare(target, one_rig);
    };
    take();
    EXPECT_EQ(certainties().size(), views.size()) << "all are learnt until they are known";
    constexpr int known = 5;
    for (int i = 1; i < known; ++i) take();
    const std::vector<double> at_first = certainties();
    for (std::size_t i = 0; i + 1 < views.size(); ++i) {
        const std::vector<double> before = certainties();
        take();
        const std::vector<double> after = certainties();
        EXPECT_FALSE(std::equal(before.begin(), before.end(), after.begin(), std::less<>()))
            << "not all of them at once";
    }
    const std::vector<double> at_last = certainties();
    EXPECT_TRUE(std::equal(at_first.begin(), at_first.end(), at_last.begin(), std::less<>()))
        << "each one in its turn";
}

class RefinedBackgroundTest : public StagedPreparerTest {
  protected:
    static std::vector<DepthView> rigs(int width_px = staged_width_px) {
        std::vector<DepthView> views;
        for (const double x_m : {-0.6, 0.0, 0.6}) {
            views.push_back(wall_and_square(x_m, width_px, staged_height_px, {.waves = true}));
            views.back().baseline_m = 0.1;
        }
        return views;
    }
    void take_instant(const std::vector<DepthView>& views) {
        preparer_.take(views, 0.4);
        target_ = {staged_width_px, staged_height_px, views[1].K, views[1].world_from_camera};
        (void)preparer_.prepare(target_, prepare_levels().back());
    }
    /// Learns and bakes the background. Afterwards the preparer has only refinements left to do.
    void learn_and_bake() {
        for (int i = 0; i < 5; ++i) take_instant(rigs());
        preparer_.improve(target_);
        for (int i = 0; i < 2; ++i) take_instant(rigs());
    }
    int steps_until_done() {
        int steps = 1;
        while (preparer_.improve_a_step(target_)) ++steps;
        return steps;
    }

    VirtualView target_;
};

TEST_F(RefinedBackgroundTest, RunsInStepsAndThenRestsForAWhile) {
    learn_and_bake();
    EXPECT_GT(steps_until_done(), 3);
    EXPECT_EQ(steps_until_done(), 1) << "there is nothing to do before the next instants";
}

TEST_F(RefinedBackgroundTest, WaitsUntilTheBackgroundIsKnown) {
    for (int i = 0; i < 4; ++i) take_instant(rigs());
    EXPECT_EQ(steps_until_done(), 1);
}

TEST_F(RefinedBackgroundTest, IsAbandonedIfARigChangesMeanwhile) {
    learn_and_bake();
    ASSERT_TRUE(preparer_.improve_a_step(target_));
    take_instant(rigs(staged_width_px + 20));
    // The next one begins with the rigs as they are.
    EXPECT_LT(steps_until_done(), 100);
    for (int i = 0; i < 5; ++i) take_instant(rigs(staged_width_px + 20));
    EXPECT_LT(steps_until_done(), 100);
    const std::shared_ptr<const Instant> instant =
        preparer_.prepare(target_, prepare_levels().front());
    ASSERT_EQ(instant->rigs.size(), 3u);
    EXPECT_EQ(instant->rigs[0].surface->depth().width_px(), staged_width_px + 20);
}

/// Three rigs whose own depth misses a pole before a wall.
class MatchedBackgroundTest : public StagedPreparerTest {
  protected:
    static constexpr double dt_s = 0.4;

    /// An empty `pole` means no pole.
    static std::vector<DepthView> rigs(const cv::Rect& pole) {
        std::vector<DepthView> views;
        for (const double x_m : {0.0, -0.4, 0.4}) {
            const BackgroundView set = background_with_pole(x_m, pole);
            DepthView view;
            view.name = std::to_string(x_m);
            view.K = set.K;
            view.world_from_camera = set.world_from_camera;
            view.baseline_m = set.baseline_m;
            view.colour = set.colour;
            view.depth_m = set.depth_m;
            views.push_back(view);
        }
        return views;
    }
    /// Films for a time and returns the share of the pole that has the right depth at the end.
    double pole_share(double seconds, const cv::Rect& pole = pole_place) {
        const std::vector<DepthView> views = rigs(pole);
        const VirtualView target{matched_size.width, matched_size.height, views[0].K,
                                 views[0].world_from_camera};
        DepthImage depth_m;
        for (int i = 0; i < std::lround(seconds / dt_s); ++i) {
            preparer_.take(views, dt_s);
            depth_m = preparer_.prepare(target, prepare_levels().front())
                          ->rigs.at(0)
                          .surface->depth()
                          .download();
            preparer_.improve(target);
        }
        const cv::Mat off = cv::abs(depth_m(pole_place) - near_pole_m);
        return cv::countNonZero(off < 0.05 * near_pole_m) / static_cast<double>(pole_place.area());
    }
};

TEST_F(MatchedBackgroundTest, FindsAPoleThatTheRigsOwnDepthMisses) {
    EXPECT_LT(pole_share(1.2), 0.1);
    EXPECT_GT(pole_share(4), 0.8);
}

/// Instants right after cuts are shown before they are learnt.
TEST_F(MatchedBackgroundTest, WaitsUntilTwoRigsHaveABackground) {
    const std::vector<DepthView> views = rigs(pole_place);
    for (int i = 0; i < 10; ++i) {
        preparer_.cut();
        preparer_.take(views, dt_s);
        preparer_.improve(
            {matched_size.width, matched_size.height, views[0].K, views[0].world_from_camera});
    }
    EXPECT_GT(pole_share(8), 0.8);
}

TEST_F(MatchedBackgroundTest, ReducesALargePicture) {
    const DepthView view = wall_and_square(0, 900, 700, {.square_x_m = 100});
    RigRoster rigs;
    BackgroundModel learner(shaders_);
    for (int i = 0; i < 5; ++i) learner.learn(*rigs.upload({&view, 1}, dt_s).at(0));
    const BackgroundView set = BackgroundModel::picture(*rigs.shown()[0]);
    EXPECT_EQ(set.colour.size(), cv::Size(450, 350));
    EXPECT_NEAR(set.K(0, 0), view.K(0, 0) / 2, 1e-6);
    EXPECT_LT(cv::norm(set.depth_m, DepthImage(350, 450, stage_wall_m), cv::NORM_INF), 0.01);
    cv::Mat1b known;
    cv::extractChannel(set.colour, known, 3);
    EXPECT_EQ(cv::countNonZero(known), 450 * 350);
}

TEST_F(MatchedBackgroundTest, LosesAPoleThatIsTakenAway) {
    ASSERT_GT(pole_share(5.2), 0.8);
    EXPECT_LT(pole_share(4, cv::Rect()), 0.1);
}

TEST_F(MatchedBackgroundTest, IsForgottenWithTheBackground) {
    ASSERT_GT(pole_share(5.2), 0.8);
    preparer_.background_access()->learn_anew();
    EXPECT_LT(pole_share(1.2), 0.1);
    EXPECT_GT(pole_share(4), 0.8) << "and matched again";
}

/// A freeze or a jump in time does not change the background.
TEST_F(StagedPreparerTest, KeepsTheBackgroundOverACut) {
    for (int i = 0; i < 8; ++i) (void)prepared(film(false));
    ASSERT_LT(learnt_off_m(), 0.02);
    preparer_.cut();
    (void)prepared(film(true));
    EXPECT_LT(learnt_off_m(), 0.02) << "foreground is not learnt";
}

TEST_F(StagedPreparerTest, LearnsNothingFromAWarmUp) {
    for (int i = 0; i < 8; ++i) (void)prepared(film(false));
    const auto learnt = std::make_shared<const Background>(preparer_.background_access()->learnt());
    StagedPreparer next(shaders_);
    next.background_access()->begin_with(learnt);
    const DepthView view = film(true);
    next.warm_up({&view, 1}, {staged_width_px, staged_height_px, view.K, view.world_from_camera});
    EXPECT_TRUE(next.background_access()->learnt().rigs.empty());
    next.take({&view, 1}, 0.2);
    EXPECT_TRUE(next.background_access()->states().at(0).is_loaded);
    EXPECT_EQ(cv::norm(next.background_access()->learnt().rigs.at(0).depth_m,
                       learnt->rigs[0].depth_m, cv::NORM_INF, square(-1)),
              0)
        << "the square stands before it";
}

TEST_F(StagedPreparerTest, KeepsTheBackgroundOfARigThatWasAway) {
    std::vector<DepthView> views{film(false), film(false)};
    views[1].name = "other";
    for (int i = 0; i < 8; ++i) preparer_.take(views, 0.2);
    for (int i = 0; i < 8; ++i) preparer_.take({views.data(), 1}, 0.2);
    EXPECT_EQ(prepared(views[0])->rigs.size(), 1u) << "it is not shown";
    EXPECT_EQ(preparer_.background_access()->learnt().rigs.size(), 2u) << "it can be saved";
    views[1] = film(true);
    views[1].name = "other";
    preparer_.take(views, 0.2);
    EXPECT_LT(learnt_off_m(1), 0.02);
}

TEST_F(StagedPreparerTest, ForgetsARemovedRigOnceItIsNotShown) {
    std::vector<DepthView> views{film(false), film(false)};
    views[1].name = "other";
    for (int i = 0; i < 8; ++i) preparer_.take(views, 0.2);
    (void)prepared(views[0]);
    preparer_.take(views, 0.2);
    preparer_.keep_only({"only"});
    EXPECT_EQ(preparer_.background_access()->learnt().rigs.size(), 2u) << "it is shown";
    for (int i = 0; i < 3; ++i) {
        preparer_.keep_only({"only"});
        EXPECT_EQ(prepared(views[0])->rigs.size(), 1u);
        // Refinements that were begun before must not touch the rig that was destroyed.
        preparer_.improve(
            {staged_width_px, staged_height_px, views[0].K, views[0].world_from_camera});
    }
    const Background learnt = preparer_.background_access()->learnt();
    ASSERT_EQ(learnt.rigs.size(), 1u);
    EXPECT_EQ(learnt.rigs[0].rig, "only");
    EXPECT_LT(learnt_off_m(0), 0.02) << "the other one keeps its own";
    views[1] = film(true);
    views[1].name = "other";
    preparer_.take(views, 0.2);
    EXPECT_GT(learnt_off_m(1), 1) << "it is learnt anew: the square counts as background";
}

}  // namespace
}  // namespace vantage
