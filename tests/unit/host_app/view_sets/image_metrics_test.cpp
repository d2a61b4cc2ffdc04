#include "host_app/view_sets/image_metrics.h"

#include <cmath>

#include <gtest/gtest.h>

namespace vantage {
namespace {

ColourImage noise(int width, int height, std::uint64_t seed) {
    ColourImage image(height, width);
    cv::RNG random(seed);
    random.fill(image, cv::RNG::UNIFORM, 0, 256);
    for (cv::Vec4b& pixel : image) pixel[3] = 255;
    return image;
}

TEST(Psnr, MatchesAKnownError) {
    const ColourImage a(7, 5, cv::Vec4b(100, 100, 100, 255));
    const ColourImage b(7, 5, cv::Vec4b(110, 110, 110, 0));
    EXPECT_NEAR(psnr_db(a, b), 10 * std::log10(255.0 * 255 / 100), 1e-9);
}

TEST(Psnr, UsesOnlyPixelsInTheMask) {
    const ColourImage a(4, 4, cv::Vec4b(0, 0, 0, 255));
    ColourImage b = a.clone();
    b(0, 0) = cv::Vec4b(255, 255, 255, 255);
    b(1, 1) = cv::Vec4b(9, 9, 9, 255);
    cv::Mat1b mask(4, 4, uchar{0});
    mask(1, 1) = 255;
    EXPECT_NEAR(psnr_db(a, b, mask), 10 * std::log10(255.0 * 255 / 81), 1e-9);
    EXPECT_EQ(psnr_db(a, b, cv::Mat1b(4, 4, uchar{0})), 0);
}

TEST(Psnr, IsTheMaximumForEqualImages) {
    const ColourImage a = noise(31, 17, 1);
    EXPECT_EQ(psnr_db(a, a), max_psnr_db);
}

TEST(Ssim, IsOneForEqualImages) {
    const ColourImage a = noise(61, 47, 2);
    EXPECT_NEAR(ssim(a, a), 1, 1e-6);
}

TEST(Ssim, IsTheLuminanceTermForFlatImages) {
    const ColourImage a(40, 40, cv::Vec4b(100, 100, 100, 255));
    const ColourImage b(40, 40, cv::Vec4b(150, 150, 150, 255));
    const double c1 = 6.5025;
    EXPECT_NEAR(ssim(a, b), (2 * 100 * 150 + c1) / (100 * 100 + 150 * 150 + c1), 1e-3);
}

TEST(Ssim, IsNearZeroForUnrelatedNoise) {
    EXPECT_LT(std::abs(ssim(noise(200, 200, 1234567), noise(200, 200, 0xfedcba987))), 0.05);
}

TEST(Ssim, AcceptsImagesSmallerThanItsWindow) {
    const ColourImage a = noise(5, 3, 5);
    EXPECT_NEAR(ssim(a, a), 1, 1e-6);
}

TEST(Coverage, CountsPixelsThatRigsSee) {
    ColourImage image(2, 4, cv::Vec4b(1, 2, 3, 255));
    image(0, 0)[3] = 64;
    image(1, 3)[3] = 0;
    EXPECT_DOUBLE_EQ(coverage(image), 6.0 / 8.0);
}

}  // namespace
}  // namespace vantage
