#include <cmath>

#include <gtest/gtest.h>

#include "common/base/time/pulse_grid.h"
#include "host_app/exports/film_export.h"

namespace vantage {
namespace {

constexpr double film_rate_hz = 50, pulses_a_second = 25;
constexpr std::uint64_t first = 45'000'000;

std::vector<FilmPicture> pictures_at(const std::vector<double>& pulses) {
    std::vector<FilmPicture> pictures;
    for (const double pulse : pulses) pictures.push_back({static_cast<double>(first) + pulse, {}});
    return pictures;
}

TEST(FilmSound, IsContinuousWherePicturesRepeatAPulse) {
    std::vector<double> pulses;
    // Now and then one comes a tick late.
    for (int i = 0; i < 200; ++i) pulses.push_back(std::floor((i - (i % 17 == 3)) / 2.0));
    const auto times = even_times(pictures_at(pulses), film_rate_hz, pulses_a_second);
    for (std::size_t i = 0; i < times.size(); ++i) {
        ASSERT_TRUE(times[i]) << i;
        EXPECT_EQ(*times[i], PulseGrid(pulses_a_second).time_of(first) +
                                 std::chrono::milliseconds(20 * static_cast<int>(i)));
    }
}

TEST(FilmSound, IsSilentUnlessTimeAdvancesAtNormalSpeed) {
    std::vector<double> pulses;
    for (int i = 0; i < 150; ++i) pulses.push_back(std::floor(i / 2.0));
    for (int i = 0; i < 150; ++i) pulses.push_back(75);
    for (int i = 0; i < 150; ++i) pulses.push_back(std::floor(75 + i / 8.0));
    for (int i = 0; i < 150; ++i) pulses.push_back(std::ceil(94 - i / 2.0));
    const auto times = even_times(pictures_at(pulses), film_rate_hz, pulses_a_second);
    EXPECT_TRUE(times[60]);
    for (const std::size_t i : {200, 250, 350, 400, 500, 560}) EXPECT_FALSE(times[i]) << i;
}

}  // namespace
}  // namespace vantage
