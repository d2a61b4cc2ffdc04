#include "host_app/instants/staged_preparer.h"

#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/gl/egl_context.h"
#include "tests/unit/synthesis/wall_and_square.h"

namespace vantage {
namespace {

constexpr int width_px = 97, height_px = 73;
constexpr float wall_m = 4, square_m = 2;

/// One rig before a wall, which a square stands before at times.
class StagedPreparerTest : public testing::Test {
  protected:
    static DepthView film(bool has_square) {
        DepthView view =
            wall_and_square(0, width_px, height_px, {.square_x_m = has_square ? 0.0 : 100.0});
        view.name = "only";
        view.baseline_m = 0.2;
        return view;
    }
    std::shared_ptr<const Instant> prepared(const DepthView& view) {
        preparer_.take({&view, 1}, 0.2);
        return preparer_.prepare({width_px, height_px, view.K, view.world_from_camera},
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
    static double unlike(const ColourImage& a, const ColourImage& b, const cv::Mat1b& where) {
        cv::Mat off, part;
        cv::absdiff(a, b, off);
        off.copyTo(part, where);
        return cv::norm(part & cv::Scalar(255, 255, 255, 0), cv::NORM_INF);
    }

    EglContext context_;
    ShaderLibrary shaders_;
    StagedPreparer preparer_{shaders_};
};

TEST_F(StagedPreparerTest, PutsPerformersBeforeTheSet) {
    for (int i = 0; i < 5; ++i) (void)prepared(film(false));
    const DepthView with = film(true);
    const std::shared_ptr<const Instant> instant = prepared(with);
    ASSERT_EQ(instant->rigs.size(), 1u);
    const RigSurface& surface = *instant->rigs[0].surface;
    const DepthImage depth_m = surface.depth().download();
    // A matte's edge is soft by a pixel.
    EXPECT_LT(cv::norm(depth_m, DepthImage(depth_m.size(), square_m), cv::NORM_INF, square(-1)),
              0.01);
    EXPECT_LT(cv::norm(depth_m, DepthImage(depth_m.size(), wall_m), cv::NORM_INF, ~square(1)),
              0.02);
    EXPECT_LE(
        unlike(surface.colour().download(), with.colour, cv::Mat1b(with.colour.size(), uchar{255})),
        1);
}

TEST_F(StagedPreparerTest, KeepsTheSetBehindPerformersAsAPlate) {
    const DepthView empty = film(false);
    EXPECT_EQ(prepared(empty)->rigs.at(0).surface->plate(), nullptr) << "nothing to remember yet";
    for (int i = 0; i < 5; ++i) (void)prepared(empty);
    const std::shared_ptr<const Instant> instant = prepared(film(true));
    const RigPlate* plate = instant->rigs.at(0).surface->plate();
    ASSERT_NE(plate, nullptr);
    const DepthImage depth_m = plate->picture().depth_m().download();
    const ColourImage colour = plate->picture().colour().download();
    EXPECT_LT(cv::norm(depth_m, DepthImage(depth_m.size(), wall_m), cv::NORM_INF), 0.02);
    EXPECT_LE(unlike(colour, empty.colour, cv::Mat1b(colour.size(), uchar{255})), 3);
    cv::Mat1b alpha;
    cv::extractChannel(colour, alpha, 3);
    EXPECT_EQ(cv::countNonZero(alpha != 255), 0) << "all of it was seen";
}

/// Depth that was closed but never measured is nothing to remember.
TEST_F(StagedPreparerTest, RemembersNothingThatWasOnlyGuessed) {
    DepthView torn = film(false);
    const cv::Rect hole(30, 20, 8, 8);
    torn.depth_m(hole) = 0.0f;
    for (int i = 0; i < 5; ++i) (void)prepared(torn);
    const std::shared_ptr<const Instant> instant = prepared(torn);
    cv::Mat1b alpha;
    cv::extractChannel(instant->rigs.at(0).surface->plate()->picture().colour().download(), alpha,
                       3);
    EXPECT_EQ(cv::countNonZero(alpha(hole)), 0);
    EXPECT_EQ(cv::countNonZero(alpha != 255), hole.area());
    const DepthImage guessed = DepthImage(instant->rigs[0].surface->depth().download())(hole);
    EXPECT_LT(cv::norm(guessed, DepthImage(hole.size(), -wall_m), cv::NORM_INF), 0.01);
}

/// What was learnt goes on in another preparer: the set behind a square that stands there from its
/// first instant on.
TEST_F(StagedPreparerTest, BeginsWithASetThatWasLearntBefore) {
    const DepthView empty = film(false);
    for (int i = 0; i < 8; ++i) (void)prepared(empty);
    const auto learnt = std::make_shared<const LearntSet>(preparer_.set_memory()->learnt());
    ASSERT_EQ(learnt->rigs.size(), 1u);
    EXPECT_EQ(preparer_.set_memory()->states().at(0).known, 1);
    EXPECT_FALSE(preparer_.set_memory()->states()[0].is_loaded);

    StagedPreparer next(shaders_);
    next.set_memory()->begin_with(learnt);
    const DepthView with = film(true);
    next.take({&with, 1}, 0.2);
    const RigSetState state = next.set_memory()->states().at(0);
    EXPECT_EQ(state.known, 1);
    EXPECT_TRUE(state.is_loaded);
    EXPECT_EQ(state.misfit, "");
    const std::shared_ptr<const Instant> instant =
        next.prepare({width_px, height_px, with.K, with.world_from_camera}, prepare_levels()[2]);
    const RigSurface& surface = *instant->rigs.at(0).surface;
    EXPECT_LT(cv::norm(DepthImage(surface.depth().download()),
                       DepthImage(with.depth_m.size(), square_m), cv::NORM_INF, square(-1)),
              0.01);
    ASSERT_NE(surface.plate(), nullptr);
    const ColourImage plate = surface.plate()->picture().colour().download();
    EXPECT_LE(unlike(plate, empty.colour, square(0)), 3);
    cv::Mat1b alpha;
    cv::extractChannel(plate, alpha, 3);
    EXPECT_EQ(cv::countNonZero(alpha != 255), 0);
}

TEST_F(StagedPreparerTest, SaysWhyALearntSetDoesNotFit) {
    for (int i = 0; i < 8; ++i) (void)prepared(film(false));
    auto learnt = std::make_shared<LearntSet>(preparer_.set_memory()->learnt());
    DepthView moved = film(false);
    moved.world_from_camera.translation().x() += 0.01;
    StagedPreparer other_place(shaders_);
    other_place.set_memory()->begin_with(learnt);
    other_place.take({&moved, 1}, 0.2);
    RigSetState state = other_place.set_memory()->states().at(0);
    EXPECT_FALSE(state.is_loaded);
    EXPECT_NE(state.misfit.find("another calibration or picture size of rig only"),
              std::string::npos)
        << state.misfit;
    EXPECT_EQ(state.known, 0);

    learnt->rigs[0].rig = "another";
    StagedPreparer other_rig(shaders_);
    other_rig.set_memory()->begin_with(learnt);
    const DepthView view = film(false);
    other_rig.take({&view, 1}, 0.2);
    state = other_rig.set_memory()->states().at(0);
    EXPECT_FALSE(state.is_loaded);
    EXPECT_NE(state.misfit.find("has none of rig only"), std::string::npos) << state.misfit;
}

/// A square that stood there from the start is no part of a set that is learnt without it, nor does
/// a set that was loaded come back.
TEST_F(StagedPreparerTest, LearnsAnewFromAnEmptyStage) {
    for (int i = 0; i < 8; ++i) (void)prepared(film(true));
    preparer_.set_memory()->begin_with(
        std::make_shared<const LearntSet>(preparer_.set_memory()->learnt()));
    preparer_.set_memory()->learn_anew();
    for (int i = 0; i < 6; ++i) (void)prepared(film(false));
    EXPECT_EQ(preparer_.set_memory()->states().at(0).known, 1);
    EXPECT_FALSE(preparer_.set_memory()->states()[0].is_loaded);
    const LearntRigSet set = preparer_.set_memory()->learnt().rigs.at(0);
    EXPECT_LT(cv::norm(set.depth_m, DepthImage(set.depth_m.size(), wall_m), cv::NORM_INF), 0.02);
    preparer_.forget();
    (void)prepared(film(false));
    EXPECT_FALSE(preparer_.set_memory()->states().at(0).is_loaded);
}

/// After a cut the picture comes first: a rig that is not in it learns from the next instant on.
TEST_F(StagedPreparerTest, LeavesRigsThatAreNotShownForLaterAfterACut) {
    std::vector<DepthView> views{film(false), film(false)};
    views[1].name = "other";
    const VirtualView target{width_px, height_px, views[0].K, views[0].world_from_camera};
    const PrepareLevel one_rig{3, 1, false, false};
    const auto learnt = [&] { return preparer_.set_memory()->learnt().rigs.size(); };
    const auto show = [&](const PrepareLevel& level) {
        return preparer_.prepare(target, level)->rigs.size();
    };
    preparer_.take(views, 0.2);
    EXPECT_EQ(learnt(), 2u) << "no cut";
    preparer_.forget();
    preparer_.take(views, 0.2);
    EXPECT_EQ(learnt(), 0u);
    EXPECT_EQ(show(one_rig), 1u);
    EXPECT_EQ(learnt(), 1u);
    EXPECT_EQ(show(prepare_levels().front()), 2u) << "bettered, all are needed";
    EXPECT_EQ(learnt(), 2u);
    preparer_.forget();
    preparer_.take(views, 0.2);
    (void)show(one_rig);
    preparer_.take(views, 0.2);
    EXPECT_EQ(learnt(), 2u) << "nobody is left out for ever";
}

}  // namespace
}  // namespace vantage
