#include "host_app/refine/gain_compensation.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

using Gains = Eigen::Vector3d;
constexpr double sample_s = GainCompensation::sample_period_s;

/// A patterned wall at z = 4 m, as seen from (x, 0, 0) along z by a rig with gains in linear light.
DepthView wall(const std::string& name, double x_m, const Gains& gains) {
    constexpr int width_px = 121, height_px = 91;
    DepthView view;
    view.name = name;
    view.K << 100, 0, 60, 0, 100, 45, 0, 0, 1;
    view.world_from_camera.translation().x() = x_m;
    view.colour.create(height_px, width_px);
    view.depth_m = DepthImage(height_px, width_px, 4.0f);
    for (int v = 0; v < height_px; ++v)
        for (int u = 0; u < width_px; ++u) {
            const double x = x_m + 4 * (u - 60) / 100.0, y = 4 * (v - 45) / 100.0;
            const Gains light(0.3 + 0.15 * std::sin(3 * x), 0.3 + 0.15 * std::cos(4 * y),
                              0.3 + 0.1 * std::sin(2 * x + 3 * y));
            for (int c = 0; c < 3; ++c)
                view.colour(v, u)[c] =
                    cv::saturate_cast<uchar>(255 * srgb_encode(std::min(1.0, gains[c] * light[c])));
            view.colour(v, u)[3] = 255;
        }
    return view;
}

/// The largest ratio, less 1, between two rigs' colours of one surface after the gains.
double difference(const GainCompensation& gain_compensation,
                  const std::map<std::string, Gains>& distorted) {
    double most = 0;
    for (const auto& [a, gains_a] : distorted)
        for (const auto& [b, gains_b] : distorted)
            for (int c = 0; c < 3; ++c)
                most =
                    std::max(most, gain_compensation.rigs().at(a).gain()[c] * gains_a[c] /
                                           (gain_compensation.rigs().at(b).gain()[c] * gains_b[c]) -
                                       1);
    return most;
}

class CompensatedRigs : public testing::Test {
  protected:
    std::vector<DepthView> views() const {
        return {wall("west", -0.5, distorted_.at("west")),
                wall("middle", 0, distorted_.at("middle")),
                wall("east", 0.5, distorted_.at("east"))};
    }
    std::map<std::string, Gains> distorted_{
        {"west", {1.1, 1.0, 0.92}}, {"middle", {1, 1, 1}}, {"east", {0.9, 1.05, 1.0}}};
    GainCompensation gain_compensation_;
};

TEST_F(CompensatedRigs, ConvergeWithoutOvershootAndWithoutDrift) {
    const std::vector<DepthView> views = this->views();
    gain_compensation_.see(views, sample_s);
    double before = difference(gain_compensation_, distorted_);
    EXPECT_GT(before, 0.15);
    for (int look = 0; look < 150; ++look) {
        gain_compensation_.see(views, sample_s);
        const double now = difference(gain_compensation_, distorted_);
        EXPECT_LT(now, before + 0.002) << look;
        before = now;
        Gains mean = Gains::Zero();
        for (const auto& [name, rig] : gain_compensation_.rigs()) mean += rig.log_gain / 3;
        ASSERT_LT(mean.norm(), 1e-9) << "the stage as a whole keeps its colour";
    }
    EXPECT_LT(before, 0.012);
    EXPECT_GT(gain_compensation_.rigs().at("middle").samples, 500);
}

TEST_F(CompensatedRigs, ApplyGainsAfterTheCalibration) {
    DepthView view = views()[0];
    view.colour_correction.matrix << 0.9, 0.1, 0, 0, 1, 0, 0.05, 0, 0.95;
    const Eigen::Matrix3d of_calibration = view.colour_correction.matrix;
    gain_compensation_.apply(view);
    EXPECT_EQ(view.colour_correction.matrix, of_calibration) << "a rig that was never sampled";
    const std::vector<DepthView> views = this->views();
    for (int look = 0; look < 20; ++look) gain_compensation_.see(views, sample_s);
    gain_compensation_.apply(view);
    const Gains gain = gain_compensation_.rigs().at("west").gain();
    EXPECT_LT(gain[0], 0.98) << "it is too red";
    EXPECT_TRUE(view.colour_correction.matrix.isApprox(gain.asDiagonal() * of_calibration));
}

TEST_F(CompensatedRigs, AreLeftAloneIfTheDifferenceIsInvisible) {
    distorted_ = {{"west", {1.003, 1, 0.997}}, {"middle", {1, 1, 1}}, {"east", {1, 0.998, 1}}};
    std::vector<DepthView> views = this->views();
    for (int look = 0; look < 100; ++look) gain_compensation_.see(views, sample_s);
    for (DepthView& view : views) {
        gain_compensation_.apply(view);
        EXPECT_TRUE(view.colour_correction.is_identity()) << view.name;
    }
}

TEST_F(CompensatedRigs, NeverChangeFasterThanTheLimit) {
    distorted_["east"] = {0.7, 1.3, 1.0};
    const std::vector<DepthView> views = this->views();
    for (int look = 0; look < 30; ++look) {
        const auto before = gain_compensation_.rigs();
        gain_compensation_.see(views, sample_s);
        for (const auto& [name, rig] : before)
            ASSERT_LE(
                (gain_compensation_.rigs().at(name).log_gain - rig.log_gain).cwiseAbs().maxCoeff(),
                GainCompensation::slew_per_s * sample_s + 1e-12);
    }
}

/// A very bright object crosses one rig's picture and hides a third of its width: a performer
/// before the wall, or the reflection of a lamp.
TEST_F(CompensatedRigs, DoNotPumpWhenABrightObjectMovesThrough) {
    distorted_ = {{"west", {1, 1, 1}}, {"middle", {1, 1, 1}}, {"east", {1, 1, 1}}};
    for (const bool has_depth : {true, false}) {
        GainCompensation gain_compensation;
        for (int look = 0; look < 60; ++look) {
            std::vector<DepthView> views = this->views();
            const cv::Rect thing(2 * look % 80, 0, 40, 91);
            views[1].colour(thing).setTo(cv::Scalar(240, 235, 230, 255));
            if (has_depth) views[1].depth_m(thing).setTo(2.5f);
            gain_compensation.see(views, sample_s);
            for (const auto& [name, rig] : gain_compensation.rigs())
                ASSERT_LT(rig.log_gain.cwiseAbs().maxCoeff(), 0.01)
                    << name << ", look " << look << ", has_depth " << has_depth;
        }
    }
}

TEST_F(CompensatedRigs, ContinueWithTheirLastGainsWhenTheyComeBack) {
    std::vector<DepthView> views = this->views();
    for (int look = 0; look < 100; ++look) gain_compensation_.see(views, sample_s);
    const Gains last = gain_compensation_.rigs().at("east").log_gain;
    EXPECT_GT(last.norm(), 0.05);
    const DepthView east = views.back();
    views.pop_back();
    for (int look = 0; look < 50; ++look) gain_compensation_.see(views, sample_s);
    EXPECT_EQ(gain_compensation_.rigs().at("east").log_gain, last);
    views.push_back(east);
    gain_compensation_.see(views, sample_s);
    EXPECT_LT((gain_compensation_.rigs().at("east").log_gain - last).norm(), 0.01);
}

TEST_F(CompensatedRigs, KeepTheirGainsIfTheyShareTooFewSamples) {
    const DepthView apart[] = {wall("west", -10, {1.2, 1, 1}), wall("east", 10, {1, 1, 1})};
    for (int look = 0; look < 10; ++look) gain_compensation_.see(apart, sample_s);
    for (const auto& [name, rig] : gain_compensation_.rigs()) {
        EXPECT_EQ(rig.log_gain, Gains(Gains::Zero())) << name;
        EXPECT_EQ(rig.samples, 0);
    }
    DepthView without_depth = wall("middle", 0, {1, 1, 1});
    without_depth.depth_m.release();
    const DepthView blind[] = {without_depth, wall("east", 0.1, {1, 1, 1})};
    gain_compensation_.see(blind, sample_s);
    EXPECT_EQ(gain_compensation_.rigs().count("middle"), 0u);
}

TEST_F(CompensatedRigs, AreSampledOnlyAFewTimesPerSecond) {
    const std::vector<DepthView> views = this->views();
    gain_compensation_.see(views, 0);
    const Gains first = gain_compensation_.rigs().at("west").log_gain;
    gain_compensation_.see(views, 0.5 * sample_s);
    EXPECT_EQ(gain_compensation_.rigs().at("west").log_gain, first);
    gain_compensation_.see(views, 0.5 * sample_s);
    EXPECT_NE(gain_compensation_.rigs().at("west").log_gain, first);
}

}  // namespace
}  // namespace vantage
