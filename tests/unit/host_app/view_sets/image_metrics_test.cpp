#include "host_app/view_sets/image_metrics.h"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

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

/// Grey steps of three pixels, so that neighbouring pixels differ.
ColourImage steps(cv::Size size, int later_px = 0) {
    ColourImage image(size);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const auto level = static_cast<uchar>(40 + 53 * ((x + later_px) / 3 % 4) + y % 2);
            image(y, x) = cv::Vec4b(level, level, level, 255);
        }
    return image;
}

TEST(ImmersiveMetricsTest, GivesEqualImagesTheErrorOfOneLevel) {
    const ColourImage image = steps({64, 48});
    const ImmersiveMetrics found = immersive_metrics(image, image);
    EXPECT_NEAR(found.iv_psnr_db, 10 * std::log10(64 * 48 * 255.0 * 255.0), 1e-9);
    EXPECT_NEAR(found.iv_ssim, 1, 1e-12);
}

TEST(ImmersiveMetricsTest, IgnoresAShiftOfTwoPixels) {
    const ColourImage image = steps({64, 48}), shifted = steps({64, 48}, 2);
    EXPECT_LT(psnr_db(image, shifted), 20);
    // Only the column at the edge shows something new.
    EXPECT_GT(immersive_metrics(image, shifted).iv_psnr_db, 50);
    EXPECT_GT(immersive_metrics(image, shifted).iv_ssim, 0.95);
}

TEST(ImmersiveMetricsTest, IgnoresAConstantDifferenceOfOnePerCent) {
    const ColourImage image(24, 32, cv::Vec4b(100, 100, 100, 255));
    const ColourImage close(24, 32, cv::Vec4b(103, 103, 103, 255));
    const ColourImage apart(24, 32, cv::Vec4b(105, 105, 105, 255));
    const ImmersiveMetrics within = immersive_metrics(image, close);
    EXPECT_NEAR(within.iv_psnr_db, 10 * std::log10(24 * 32 * 255.0 * 255.0), 1e-9);
    // Two levels of luma remain; the components of colour are equal.
    const double luma_db = 10 * std::log10(255.0 * 255.0 / 4);
    EXPECT_NEAR(immersive_metrics(image, apart).iv_psnr_db,
                (4 * luma_db + 2 * within.iv_psnr_db) / 6, 1e-9);
}

TEST(ImmersiveMetricsTest, TakesTheSmallerOfBothDirections) {
    ColourImage plain(24, 32, cv::Vec4b(100, 100, 100, 255)), dot = plain.clone();
    dot(12, 16) = cv::Vec4b(220, 220, 220, 255);
    // Every plain pixel has a plain neighbour, but the dot has none like it.
    const double luma_db = 10 * std::log10(24 * 32 * 255.0 * 255.0 / (120 * 120));
    const double equal_db = 10 * std::log10(24 * 32 * 255.0 * 255.0);
    EXPECT_NEAR(immersive_metrics(plain, dot).iv_psnr_db, (4 * luma_db + 2 * equal_db) / 6, 1e-9);
    EXPECT_DOUBLE_EQ(immersive_metrics(plain, dot).iv_psnr_db,
                     immersive_metrics(dot, plain).iv_psnr_db);
}

TEST(ImmersiveMetricsTest, CountsOnlyThePixelsOfTheMask) {
    const ColourImage image = steps({64, 48});
    ColourImage wrong = image.clone();
    wrong(cv::Rect(0, 0, 24, 48)) = cv::Vec4b(255, 0, 255, 255);
    cv::Mat1b mask(image.size(), 0);
    mask(cv::Rect(40, 0, 24, 48)) = 255;
    EXPECT_LT(immersive_metrics(image, wrong).iv_psnr_db, 20);
    const ImmersiveMetrics inside = immersive_metrics(image, wrong, mask);
    EXPECT_NEAR(inside.iv_psnr_db, 10 * std::log10(24 * 48 * 255.0 * 255.0), 1e-9);
    EXPECT_NEAR(inside.iv_ssim, 1, 1e-12);
    EXPECT_EQ(immersive_metrics(image, wrong, cv::Mat1b(image.size(), 0)).iv_psnr_db, 0);
}

}  // namespace

}  // namespace vantage
