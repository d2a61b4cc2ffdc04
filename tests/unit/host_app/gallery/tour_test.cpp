#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "host_app/gallery/tour_preparer.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/view_sets/image_metrics.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/host_app/gallery/gallery_scene.h"

namespace vantage {
namespace {

/// From 3 m before a ball that stands on the floor, y pointing down.
DepthView seen_from(const Eigen::Vector3d& from_m, bool has_ball) {
    const cv::Size size(161, 121);
    Eigen::Matrix3d K;
    K << 0.9 * size.width, 0, 0.5 * (size.width - 1), 0, 0.9 * size.width, 0.5 * (size.height - 1),
        0, 0, 1;
    DepthView view =
        BallScene{has_ball, 0.5}.seen_from(look_at(from_m, {0, 0.4, 0}, {0, -1, 0}), K, size);
    view.name = "film";
    return view;
}

class TourTest : public testing::Test {
  protected:
    ColourImage fly(const std::string& name, const DepthView& target) {
        Synthesiser synthesiser(find_synthesiser(name), shaders_);
        const DepthView empty = seen_from({0, -0.6, -3}, false),
                        full = seen_from({0, -0.6, -3}, true);
        for (int i = 0; i < 8; ++i) synthesiser.set_views({&empty, 1}, 0.2);
        synthesiser.set_views({&full, 1}, 0.2);
        return synthesiser.render(view_of_scene(target)).download();
    }

    EglContext context_;
    ShaderLibrary shaders_;
};

TEST_F(TourTest, ShowsFloorBackPlaneAndPerformerFromBesideTheFilm) {
    for (const Eigen::Vector3d& from :
         {Eigen::Vector3d(0.4, -0.6, -3), Eigen::Vector3d(-0.3, -0.8, -2.6)}) {
        const DepthView truth = seen_from(from, true);
        const ColourImage picture = fly("tour:up=-y,floor-m=-1,back-m=5", truth);
        EXPECT_GT(coverage(picture), 0.8);
        EXPECT_GT(psnr_db(picture, truth.colour, covered_mask(picture)), 25);
        const Outline seen = red_outline(picture), wanted = red_outline(truth.colour);
        EXPECT_NEAR(seen.middle.x, wanted.middle.x, 3);
        EXPECT_NEAR(seen.middle.y, wanted.middle.y, 3);
        EXPECT_NEAR(seen.area, wanted.area, 0.15 * wanted.area);
    }
}

TEST_F(TourTest, IsTheFilmFromItsOwnPlaceWhateverTheLayout) {
    const DepthView film = seen_from({0, -0.6, -3}, true);
    EXPECT_GT(psnr_db(fly("tour:up=-y,floor-m=-1", film), film.colour), 30);
    EXPECT_GT(psnr_db(fly("tour:up=-y,floor-m=-1.5,back-m=9", film), film.colour), 30);
}

TEST_F(TourTest, SaysWhereItCannotGo) {
    const DepthView film = seen_from({0, -0.6, -3}, true);
    EXPECT_NE(thrown_sentence([&] { fly("tour:up=y,floor-m=1", film); }).find("below the floor"),
              std::string::npos);
    EXPECT_NE(thrown_sentence([&] {
                  fly("tour:up=-y,floor-m=-1,back-m=5", seen_from({0.2, 0.2, 1.9}, true));
              }).find("before the back plane"),
              std::string::npos);
}

TEST(CutOuts, ArePartsThatHangTogetherWithoutSpecks) {
    cv::Mat1b matte = cv::Mat1b::zeros(100, 100);
    matte(cv::Rect(10, 20, 10, 30)) = 255;
    matte(cv::Rect(60, 40, 20, 50)) = 200;
    matte(5, 90) = 255;
    cv::Mat1b labels;
    const std::vector<CutOut> parts = cut_outs(matte, 8, labels);
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].area_px, 1000);
    EXPECT_NEAR(parts[0].foot_px.x, 69.5, 1e-6);
    EXPECT_EQ(parts[0].foot_px.y, 89);
    EXPECT_EQ(labels(60, 70), 1);
    EXPECT_EQ(labels(30, 15), 2);
    EXPECT_EQ(labels(5, 90), 0);
    EXPECT_EQ(cut_outs(matte, 1, labels).size(), 1u);
}

}  // namespace
}  // namespace vantage
