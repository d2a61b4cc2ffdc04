#include <gtest/gtest.h>

#include "host_app/sound/alsa_capture.h"

namespace vantage {
namespace {

constexpr std::int64_t device_begin = 1'800'000'000LL * sound_rate_hz;
constexpr std::size_t block_samples = 480;

TaiTime after(std::int64_t samples) { return time_of_sound(device_begin + samples); }

TEST(SoundPlacer, PlacesBlocksContiguouslyDespiteJitter) {
    SoundPlacer placer;
    const std::vector<float> sound(block_samples * sound_channels, 0.5F);
    std::int64_t next = device_begin;
    for (int i = 1; i <= 500; ++i) {
        // It is told late now and then, by up to 4 ms.
        const std::int64_t late = i % 7 == 3 ? 192 : 0;
        const SoundBlock placed = placer.place(sound, after(i * 480 + late));
        EXPECT_EQ(placed.first, next);
        EXPECT_EQ(placed.samples, sound);
        next = placed.end();
    }
    EXPECT_EQ(placer.stats().lost + placer.stats().dropped, 0u);
    EXPECT_EQ(placer.stats().inserted + placer.stats().removed, 0u);
}

class DriftingDevice : public testing::TestWithParam<int> {};

TEST_P(DriftingDevice, StaysWithinMillisecondsOfTheClock) {
    const double ppm = GetParam();
    SoundPlacer placer;
    const std::vector<float> sound(block_samples * sound_channels, 0.5F);
    std::int64_t next = device_begin;
    double true_end = 0;
    for (int i = 0; i < 60'000; ++i) {
        true_end += 480 / (1 + ppm / 1e6);
        const auto until = static_cast<std::int64_t>(true_end);
        const SoundBlock placed = placer.place(sound, after(until));
        ASSERT_EQ(placed.first, i == 0 ? placed.first : next) << "there is no gap";
        next = placed.end();
        ASSERT_NEAR(static_cast<double>(next - device_begin), true_end, 0.003 * sound_rate_hz) << i;
    }
    EXPECT_NEAR(placer.stats().drift_ppm(), ppm, 0.1 * std::abs(ppm) + 2);
}

INSTANTIATE_TEST_SUITE_P(Clocks, DriftingDevice, testing::Values(-300, -20, 50, 300));

TEST(SoundPlacer, LeavesAGapAfterAnOutageAndDropsSoundThatComesTooFast) {
    SoundPlacer placer;
    const std::vector<float> sound(block_samples * sound_channels, 0.5F);
    placer.place(sound, after(480));
    const SoundBlock back = placer.place(sound, after(960 + 48'000));
    EXPECT_EQ(back.first, device_begin + 480 + 48'000);
    EXPECT_EQ(placer.stats().lost, 48'000u);
    for (int i = 0; i < 100; ++i) placer.place(sound, after(960 + 48'000));
    EXPECT_EQ(placer.stats().dropped, (100u - 25u) * 480u)
        << "a quarter of a second is no run-away";
    EXPECT_EQ(placer.stats().heard, 102u * 480u);
}

TEST(Stretched, IsBitExactAtTheSameLengthAndSmoothOtherwise) {
    std::vector<float> tone;
    for (int i = 0; i < 960; ++i)
        tone.insert(tone.end(), 2, std::sin(2 * std::numbers::pi_v<float> * 440 * i / 48000));
    EXPECT_EQ(stretched(tone, 960), tone);
    const std::vector<float> longer = stretched(tone, 964);
    ASSERT_EQ(longer.size(), 964 * sound_channels);
    for (int i = 0; i < 960; ++i)
        EXPECT_NEAR(longer[2 * static_cast<std::size_t>(i)],
                    std::sin(2 * std::numbers::pi * 440 * i * (960.0 / 964) / 48000), 0.001);
    EXPECT_TRUE(stretched({}, 3).size() == 6);
}

TEST(SoundGrid, DividesASecondAmongTicks) {
    EXPECT_EQ(SoundGrid(50).first_of(7), 7 * 960);
    const SoundGrid ntsc(29.97);
    EXPECT_EQ(ntsc.first_of(30'000), 1001LL * 48'000);
    EXPECT_EQ(ntsc.first_of(1), 1601);
    EXPECT_EQ(ntsc.first_of(5), 8008);
    EXPECT_EQ(SoundGrid(50).first_of(3'000'000'000), 3'000'000'000LL * 960);
}

TEST(SoundTime, CountsSamplesSince1970Exactly) {
    for (const std::int64_t sample :
         {std::int64_t{0}, device_begin, device_begin + 1, device_begin + 47'999})
        EXPECT_EQ(sound_sample_at(time_of_sound(sample)), sample);
}

}  // namespace
}  // namespace vantage
