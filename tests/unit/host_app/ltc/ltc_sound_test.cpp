#include "host_app/ltc/ltc_sound.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

/// One channel as sound.
SoundBlock block_of(const std::vector<float>& samples, std::int64_t first = 0) {
    SoundBlock block{first, {}};
    for (const float sample : samples) {
        block.samples.push_back(sample);
        block.samples.push_back(0);
    }
    return block;
}

struct Rate {
    double hz;
    SmpteCount count;
};

class LtcSound : public testing::TestWithParam<Rate> {
  protected:
    std::vector<float> written(std::int64_t from, int frames) const {
        LtcWriter writer(GetParam().hz);
        std::vector<float> samples;
        for (int i = 0; i < frames; ++i) {
            const std::vector<float> frame = writer.frame(GetParam().count.code_of(from + i));
            samples.insert(samples.end(), frame.begin(), frame.end());
        }
        return samples;
    }
};

TEST_P(LtcSound, RoundTrips) {
    const auto& [hz, count] = GetParam();
    // Over a minute that drops numbers, and midnight.
    for (const std::int64_t from : {std::int64_t{1700}, count.frames() - 100}) {
        const std::vector<float> samples = written(from, 200);
        EXPECT_NEAR(static_cast<double>(samples.size()), 200 * sound_rate_hz / hz, 2);
        LtcReader reader;
        std::vector<LtcReading> readings;
        // As a device gives it.
        for (std::size_t at = 0; at < samples.size(); at += 480)
            for (const LtcReading& reading :
                 reader.hear(block_of({samples.begin() + static_cast<std::ptrdiff_t>(at),
                                       samples.begin() + static_cast<std::ptrdiff_t>(
                                                             std::min(at + 480, samples.size()))},
                                      1'000'000 + static_cast<std::int64_t>(at))))
                readings.push_back(reading);
        ASSERT_GE(readings.size(), 190u);
        for (std::size_t i = 0; i < readings.size(); ++i) {
            const std::int64_t frame = *count.frame_of(readings[i].code);
            ASSERT_EQ(frame, (*count.frame_of(readings[0].code) + static_cast<std::int64_t>(i)) %
                                 count.frames());
            EXPECT_EQ(count_of(readings[i]).numbers_a_second, count.numbers_a_second);
            const double place =
                static_cast<double>(count.between(frame, from)) * sound_rate_hz / hz;
            EXPECT_NEAR(static_cast<double>(readings[i].first - 1'000'000), place, 60);
        }
        EXPECT_LE(reader.malformed(), 1u);
    }
}

TEST_P(LtcSound, CountsAndIgnoresCodesThatDoNotFollow) {
    LtcReader reader;
    std::vector<float> samples = written(1000, 10);
    const std::vector<float> elsewhere = written(50'000, 1), on = written(1011, 10);
    samples.insert(samples.end(), elsewhere.begin(), elsewhere.end());
    samples.insert(samples.end(), on.begin(), on.end());
    const SmpteCount count = GetParam().count;
    for (const LtcReading& reading : reader.hear(block_of(samples)))
        EXPECT_LT(*count.frame_of(reading.code), 2000);
    EXPECT_GE(reader.malformed(), 1u);
}

INSTANTIATE_TEST_SUITE_P(Rates, LtcSound,
                         testing::Values(Rate{24, {24}}, Rate{25, {25}},
                                         Rate{30000.0 / 1001, {30, true}}, Rate{30, {30}}));

TEST(LtcNoise, YieldsNoTimeCode) {
    LtcReader reader;
    std::vector<float> samples(200'000);
    std::uint32_t state = 1;
    for (float& sample : samples) {
        state = state * 1664525U + 1013904223U;
        sample = static_cast<float>(state >> 8) / (1 << 23) - 1;
    }
    samples[500] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(reader.hear(block_of(samples)).empty());
}

}  // namespace
}  // namespace vantage
