#include "calib_tools/sync/exposure_fit.h"

#include <random>

#include <gtest/gtest.h>

namespace vantage {
namespace {

/// Pictures whose exposures begin anywhere, of LEDs with lights and darknesses of their own.
LedLight light_of(const SyncBar& bar, const std::vector<double>& begins_ms, double length_ms,
                  int leds, double noise) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    LedLight seen;
    for (int k = 0; k < leds; ++k) seen.leds.push_back(bar.leds() - 1 - k);
    seen.light.resize(static_cast<Eigen::Index>(begins_ms.size()), leds);
    for (Eigen::Index i = 0; i < seen.light.rows(); ++i)
        for (Eigen::Index k = 0; k < leds; ++k)
            seen.light(i, k) =
                0.02 + 0.01 * static_cast<double>(k % 3) +
                (0.4 + 0.05 * static_cast<double>(k % 4)) *
                    bar.lit_share(seen.leds[static_cast<std::size_t>(k)],
                                  1e6 * begins_ms[static_cast<std::size_t>(i)], 1e6 * length_ms) +
                noise * normal(random);
    return seen;
}

TEST(ExposureFit, finds_begin_and_length_of_every_exposure) {
    const SyncBar bar(12, std::chrono::microseconds(127));
    std::mt19937 random(3);
    std::uniform_real_distribution<double> anywhere(0, 520.192);
    for (const double length_ms : {0.3, 2.0, 3.1, 5.0, 8.0, 20.0}) {
        std::vector<double> begins_ms(24);
        for (double& begin_ms : begins_ms) begin_ms = anywhere(random);
        const ExposureFit fit = fit_exposures(bar, light_of(bar, begins_ms, length_ms, 12, 0.001));
        EXPECT_NEAR(fit.length_ms, length_ms, 0.01 * length_ms);
        ASSERT_EQ(fit.exposures.size(), begins_ms.size());
        EXPECT_EQ(fit.used, 24) << length_ms;
        for (std::size_t i = 0; i < begins_ms.size(); ++i)
            EXPECT_LT(std::abs(std::remainder(
                          fit.exposures[i].centre_ms - begins_ms[i] - length_ms / 2, 520.192)),
                      std::max(0.015 * length_ms, 3 * fit.exposures[i].sigma_ms))
                << length_ms << ' ' << i;
    }
}

}  // namespace
}  // namespace vantage
