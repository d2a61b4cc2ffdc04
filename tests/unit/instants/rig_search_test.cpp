#include <gtest/gtest.h>

#include "common/gl/egl_context.h"
#include "host_app/instants/rig_consensus.h"
#include "host_app/instants/rig_roster.h"
#include "tests/unit/instants/drawn_by.h"

namespace vantage {
namespace {

const cv::Size search_size{160, 120};
constexpr float behind_pole_m = 4, thin_pole_m = 2;
const Eigen::Matrix3d search_K = (Eigen::Matrix3d() << 150, 0, 80, 0, 150, 60, 0, 0, 1).finished();
/// Of the first rig's picture.
const cv::Rect thin_pole(80, 20, 2, 80);

/// A rig at x beside others, that sees a pole before a checkered wall and takes it for the wall.
DepthView film_of_thin_pole(double x_m) {
    DepthView view;
    view.name = std::to_string(x_m);
    view.K = search_K;
    view.world_from_camera.translation().x() = x_m;
    view.baseline_m = 0.05;
    view.colour = ColourImage(search_size);
    view.depth_m = DepthImage(search_size, behind_pole_m);
    for (int y = 0; y < search_size.height; ++y)
        for (int x = 0; x < search_size.width; ++x) {
            const bool is_light =
                (std::lround(x + 150 * x_m / behind_pole_m + 400) / 5 + y / 5) % 2 == 0;
            view.colour(y, x) = is_light ? cv::Vec4b(60, 140, 60, 255) : cv::Vec4b(20, 60, 20, 255);
        }
    const cv::Rect seen(thin_pole.x - static_cast<int>(std::lround(150 * x_m / thin_pole_m)),
                        thin_pole.y, thin_pole.width, thin_pole.height);
    view.colour(seen) = cv::Vec4b(220, 160, 230, 255);
    return view;
}

class RigSearchTest : public testing::Test {
  protected:
    /// Of the first rig, whose depth is known or not where the pole is.
    DepthImage kept(const std::vector<double>& places_m, float pole_depth_m) {
        std::vector<DepthView> rigs;
        for (const double x_m : places_m) rigs.push_back(film_of_thin_pole(x_m));
        RigRoster views;
        views.upload(rigs, nominal_dt_s);
        const std::vector<ComparedView> all = compared(views.shown());
        DepthImage before_m(search_size, behind_pole_m);
        before_m(thin_pole) = pole_depth_m;
        const Texture before = texture_of(TextureFormat::r32f, before_m);
        const Texture found(TextureFormat::r32f, search_size.width, search_size.height);
        has_searched_ = consensus_.search(all[0], all, before, Framebuffer{&found});
        return has_searched_
                   ? DepthImage(consensus_.with_found(all[0], before, found).download().clone())
                   : before_m;
    }

    EglContext context_;
    ShaderLibrary shaders_;
    RigConsensus consensus_{shaders_};
    bool has_searched_ = false;
};

TEST_F(RigSearchTest, FindsAThinThingThatWasTakenForWhatIsBehindIt) {
    const DepthImage kept_m = kept({0, -0.4, 0.4}, -behind_pole_m);
    ASSERT_TRUE(has_searched_);
    const cv::Mat off = cv::abs(kept_m(thin_pole) - thin_pole_m);
    EXPECT_GT(cv::countNonZero(off < 0.03 * thin_pole_m), 0.9 * thin_pole.area());
    // And touches nothing else.
    cv::Mat1b changed = kept_m != behind_pole_m;
    changed(thin_pole) = 0;
    EXPECT_EQ(cv::countNonZero(changed), 0);
}

TEST_F(RigSearchTest, FindsTheSameStepByStep) {
    const DepthImage at_once = kept({0, -0.4, 0.4}, -behind_pole_m);
    DepthImage in_steps;
    std::deque<RigConsensus::Step> steps;
    std::vector<DepthView> rigs;
    for (const double x_m : {0.0, -0.4, 0.4}) rigs.push_back(film_of_thin_pole(x_m));
    RigRoster views;
    views.upload(rigs, nominal_dt_s);
    DepthImage before_m(search_size, behind_pole_m);
    before_m(thin_pole) = -behind_pole_m;
    const Texture before = texture_of(TextureFormat::r32f, before_m);
    const Texture found(TextureFormat::r32f, search_size.width, search_size.height);
    const Framebuffer target{&found};
    const Texture* result = nullptr;
    steps = consensus_.in_steps([&] {
        const std::vector<ComparedView> all = compared(views.shown());
        ASSERT_TRUE(consensus_.search(all[0], all, before, target));
        result = &consensus_.with_found(all[0], before, found);
    });
    EXPECT_GT(steps.size(), 5u);
    for (const RigConsensus::Step& step : steps) step();
    ASSERT_NE(result, nullptr);
    EXPECT_EQ(cv::norm(DepthImage(result->download()), at_once, cv::NORM_INF), 0);
}

TEST_F(RigSearchTest, LeavesMeasuredDepthAlone) {
    EXPECT_EQ(cv::countNonZero(kept({0, -0.4, 0.4}, behind_pole_m) != behind_pole_m), 0);
    EXPECT_TRUE(has_searched_);
}

TEST_F(RigSearchTest, NeedsTwoOthersThatStandApart) {
    kept({0, 0.4}, -behind_pole_m);
    EXPECT_FALSE(has_searched_);
    kept({0, -0.04, 0.04}, -behind_pole_m);
    EXPECT_FALSE(has_searched_);
}

}  // namespace
}  // namespace vantage
