#include "calib_tools/colour/colour_match.h"

#include <numbers>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "calib_tools/colour/cielab.h"
#include "calib_tools/colour/overlap.h"
#include "common/gl/context/egl_context.h"
#include "common/virtual_stage/virtual_rig.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using testing::HasSubstr;

/// A camera whose colours are not the stage's: channels that leak into each other, white balance
/// and response of its own.
ColourCorrection odd_response(int camera) {
    ColourCorrection response;
    const double s = 0.04 * camera;
    response.matrix << 0.92 - s, 0.06, 0.02, s, 0.88, 0.05, 0.03, 0.08, 0.80 + s;
    response.tone = Eigen::Vector3d(1.0 + 0.1 * camera, 1.06, 1.0 - 0.05 * camera);
    return response;
}

double mean_delta_e(const ColourImage& a, const ColourImage& b) {
    double sum = 0;
    int count = 0;
    for (int y = 0; y < a.rows; y += 2)
        for (int x = 0; x < a.cols; x += 2, ++count) {
            const cv::Vec4b &p = a(y, x), &q = b(y, x);
            sum += delta_e_2000(lab_from_coded(Eigen::Vector3d(p[0], p[1], p[2]) / 255),
                                lab_from_coded(Eigen::Vector3d(q[0], q[1], q[2]) / 255));
        }
    return sum / count;
}

TEST(DeltaE2000, gives_the_published_differences) {
    // From the test data of Sharma, Wu, Dalal (2005), table 1.
    EXPECT_NEAR(delta_e_2000({50, 2.6772, -79.7751}, {50, 0, -82.7485}), 2.0425, 1e-4);
    EXPECT_NEAR(delta_e_2000({50, 2.5, 0}, {73, 25, -18}), 27.1492, 1e-4);
    EXPECT_NEAR(delta_e_2000({50, 2.49, -0.001}, {50, -2.49, 0.0011}), 7.2195, 1e-4);
    EXPECT_NEAR(delta_e_2000({2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}), 0.9082, 1e-4);
    EXPECT_NEAR(delta_e_2000({60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}), 1.2644,
                1e-4);
}

/// Four rigs around the virtual stage; each but the first sees through an odd response and noise.
struct FilmedColours {
    std::vector<OverlapView> views;
    std::vector<ColourImage> true_colours;
};

FilmedColours film_stage() {
    const EglContext context;
    const ShaderLibrary shaders;
    VirtualStage stage(shaders);
    FilmedColours filmed;
    for (int i = 0; i < 4; ++i) {
        VirtualRigPlacement placement;
        placement.azimuth_rad = (i - 1.5) * 40 * std::numbers::pi / 180;
        placement.distance_m = 4;
        placement.width_px = 311;
        placement.height_px = 239;
        const StereoCalibration rig = ideal_virtual_rig(placement);
        StageCamera camera{311, 239, rig.rectified.K_left(), rig.world_from_left};
        const StageRendering seen = stage.render(camera, std::chrono::seconds(1));
        OverlapView view;
        view.name = std::string(1, static_cast<char>('A' + i));
        view.colour = i == 0 ? seen.colour.clone() : odd_response(i).apply(seen.colour);
        add_sensor_noise(view.colour, {2.0, 7}, 0, static_cast<std::uint64_t>(i));
        view.depth_m = seen.depth_m;
        view.K = camera.K;
        view.world_from_camera = camera.world_from_camera;
        view.baseline_m = 0.12;
        filmed.views.push_back(view);
        filmed.true_colours.push_back(seen.colour);
    }
    return filmed;
}

TEST(MatchColours, makes_rigs_alike_from_what_they_see_of_one_another) {
    const FilmedColours filmed = film_stage();
    const ColourMatch match =
        match_colours(4, same_surface(overlap_samples(filmed.views, 1500)), 0);
    EXPECT_TRUE(match.cameras[0].correction.is_identity());
    double worst = 0;
    for (std::size_t i = 1; i < 4; ++i) {
        // Without the noise: what is judged is the correction.
        const ColourImage odd = odd_response(static_cast<int>(i)).apply(filmed.true_colours[i]);
        const double before = mean_delta_e(odd, filmed.true_colours[i]);
        const double after =
            mean_delta_e(match.cameras[i].correction.apply(odd), filmed.true_colours[i]);
        RecordProperty("rig_" + std::to_string(i), std::to_string(after));
        EXPECT_GT(before, 4) << i;
        EXPECT_LT(after, 1.0) << i;
        worst = std::max(worst, after);
    }
    EXPECT_LT(match.delta_e_after, 0.5 * match.delta_e_before);
}

TEST(MatchColours, leaves_a_camera_alone_that_shares_nothing) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> value(0.1, 0.9);
    std::vector<ColourPair> pairs;
    for (int i = 0; i < 60; ++i) {
        const Eigen::Vector3d c(value(random), value(random), value(random));
        pairs.push_back({0, 1, c, odd_response(1).apply(c)});
    }
    const ColourMatch match = match_colours(3, pairs, 0);
    EXPECT_EQ(match.cameras[2].samples, 0);
    EXPECT_TRUE(match.cameras[2].correction.matrix.isApprox(Eigen::Matrix3d::Identity(), 1e-6));
    EXPECT_LT(match.cameras[1].delta_e_after, 0.3);
    EXPECT_THAT(thrown_sentence([&] {
                    match_colours(2, {pairs.begin(), pairs.begin() + 5}, 0);
                }),
                HasSubstr("24 are needed"));
}

/// The chart, tilted before a grey wall.
ColourImage draw_chart() {
    constexpr int side = 60, gap = 12;
    cv::Mat3b flat(4 * (side + gap) + gap, 6 * (side + gap) + gap, cv::Vec3b(12, 12, 12));
    const std::vector<Eigen::Vector3d> colours = chart_colours();
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 6; ++column) {
            const Eigen::Vector3d c = 255 * colours[static_cast<std::size_t>(6 * row + column)];
            flat(cv::Rect(gap + column * (side + gap), gap + row * (side + gap), side, side))
                .setTo(cv::Scalar(c[0], c[1], c[2]));
        }
    const cv::Matx33d tilt(0.9, 0.05, 80, -0.04, 0.92, 70, -1e-4, 1.2e-4, 1);
    cv::Mat3b picture;
    cv::warpPerspective(flat, picture, tilt, {640, 480}, cv::INTER_AREA, cv::BORDER_CONSTANT,
                        cv::Scalar(128, 124, 120));
    cv::GaussianBlur(picture, picture, {}, 0.8);
    ColourImage result;
    cv::cvtColor(picture, result, cv::COLOR_RGB2RGBA);
    return result;
}

TEST(MatchChart, brings_the_patches_of_a_filmed_chart_to_their_true_colours) {
    ColourImage filmed = odd_response(2).apply(draw_chart());
    add_sensor_noise(filmed, {2.0, 3}, 0, 0);
    const auto patches = find_chart(filmed);
    ASSERT_TRUE(patches);
    ASSERT_EQ(patches->size(), 24u);
    const ColourMatch::Camera camera = match_chart(*patches);
    EXPECT_GT(camera.delta_e_before, 4);
    EXPECT_LT(camera.delta_e_after, 1.0);
}

TEST(MatchChart, finds_no_chart_where_there_is_none_and_refuses_burnt_out_ones) {
    EXPECT_FALSE(find_chart(ColourImage(120, 160, cv::Vec4b(90, 90, 90, 255))));
    std::vector<ColourPatch> patches;
    for (const Eigen::Vector3d& colour : chart_colours())
        patches.push_back({Eigen::Vector3d::Ones(), colour});
    EXPECT_THAT(thrown_sentence([&] { match_chart(patches); }), HasSubstr("exposure"));
}

}  // namespace
}  // namespace vantage
