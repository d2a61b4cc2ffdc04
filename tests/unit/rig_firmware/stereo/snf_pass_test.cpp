#include <gtest/gtest.h>

#include "rig_firmware/stereo/thesis/thesis_passes.h"
#include "tests/references/thesis/snf_reference.h"
#include "tests/unit/rig_firmware/stereo/thesis_buffers.h"

namespace vantage::thesis {
namespace {

class SnfPassTest : public testing::TestWithParam<PictureCase> {};

TEST_P(SnfPassTest, EqualsItsReference) {
    const EglContext context;
    const ShaderLibrary library;
    const ColourImage picture = blobs(GetParam().width_px, GetParam().height_px, 3);
    SnfPass pass(library, picture.size());
    const Buffer source = to_buffer(picture), filtered = empty_words(picture.size());
    pass.run(source, filtered);
    EXPECT_EQ(cv::norm(picture_in(filtered, picture.size()), snf_reference(picture), cv::NORM_INF),
              0);
}

INSTANTIATE_TEST_SUITE_P(Sizes, SnfPassTest, testing::ValuesIn(picture_cases));

TEST(SnfReference, SmoothsNoiseAndKeepsAnEdgeSharp) {
    ColourImage picture(20, 40);
    cv::RNG random(5);
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols; ++x) {
            const int level = (x < 20 ? 60 : 180) + random.uniform(-8, 9);
            picture(y, x) = cv::Vec4b::all(static_cast<unsigned char>(level));
        }
    ColourImage filtered = picture;
    for (int i = 0; i < 6; ++i) filtered = snf_reference(filtered);
    const auto deviation = [](const ColourImage& image, int first, int end) {
        cv::Scalar mean, sigma;
        cv::meanStdDev(image.colRange(first, end), mean, sigma);
        return sigma[0];
    };
    EXPECT_LT(deviation(filtered, 0, 20), 0.6 * deviation(picture, 0, 20));
    EXPECT_LT(deviation(filtered, 20, 40), 0.6 * deviation(picture, 20, 40));
    for (int y = 0; y < filtered.rows; ++y)
        EXPECT_GT(filtered(y, 20)[0] - filtered(y, 19)[0], 100) << "row " << y;
}

}  // namespace
}  // namespace vantage::thesis
