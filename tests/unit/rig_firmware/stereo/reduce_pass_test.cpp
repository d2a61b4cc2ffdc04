#include "rig_firmware/stereo/features/reduce_pass.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/gl/context/egl_context.h"
#include "common/image/image.h"

namespace vantage {
namespace {

/// Noise with a little blur, as cameras deliver it.
ColourImage noise(cv::Size size) {
    ColourImage image(size);
    cv::RNG random(7);
    random.fill(image, cv::RNG::UNIFORM, 0, 256);
    cv::GaussianBlur(image, image, {5, 5}, 1.0);
    return image;
}

class ReducePassTest : public testing::Test {
  protected:
    ColourImage reduced(const ColourImage& image, cv::Size to) {
        ReducePass pass(library_, image.size(), to);
        Texture texture(TextureFormat::rgba8, image.cols, image.rows, Filter::linear);
        texture.upload(image);
        return ColourImage(pass.reduce(texture).download());
    }

    EglContext context_;
    ShaderLibrary library_;
};

TEST_F(ReducePassTest, AveragesBlocksWhereTheRatioIsAWholeNumber) {
    const ColourImage image = noise({96, 64});
    for (const int ratio : {2, 4}) {
        const cv::Size to(96 / ratio, 64 / ratio);
        ColourImage expected;
        cv::resize(image, expected, to, 0, 0, cv::INTER_AREA);
        EXPECT_LE(cv::norm(reduced(image, to), expected, cv::NORM_INF), 1) << ratio;
    }
}

TEST_F(ReducePassTest, StaysNearTheMeanOfTheAreaInBetween) {
    const ColourImage image = noise({100, 75});
    for (const cv::Size to : {cv::Size(80, 60), cv::Size(67, 50), cv::Size(44, 33)}) {
        ColourImage expected;
        cv::resize(image, expected, to, 0, 0, cv::INTER_AREA);
        const double rms =
            cv::norm(reduced(image, to), expected, cv::NORM_L2) / std::sqrt(4.0 * to.area());
        EXPECT_LT(rms, 3.0) << to;
    }
}

TEST_F(ReducePassTest, KeepsTheFieldOfView) {
    ColourImage ramp(60, 120);
    for (int y = 0; y < ramp.rows; ++y)
        for (int x = 0; x < ramp.cols; ++x)
            ramp(y, x) = cv::Vec4b(static_cast<uchar>(2 * x), static_cast<uchar>(4 * y), 0, 255);
    const ColourImage small = reduced(ramp, {80, 40});
    for (const cv::Point at : {cv::Point(10, 10), cv::Point(70, 30)}) {
        EXPECT_NEAR(small(at)[0], 2 * (1.5 * (at.x + 0.5) - 0.5), 1);
        EXPECT_NEAR(small(at)[1], 4 * (1.5 * (at.y + 0.5) - 0.5), 1);
    }
}

}  // namespace
}  // namespace vantage
