#include "common/base/percentiles.h"

#include <cmath>

#include <gtest/gtest.h>

namespace vantage {
namespace {

TEST(Percentiles, AreZeroWithoutSamples) {
    const Percentiles p = PercentileRecorder().summary();
    EXPECT_EQ(p.count, 0u);
    EXPECT_EQ(p.p50, 0);
    EXPECT_EQ(p.max, 0);
}

TEST(Percentiles, EqualASingleSample) {
    PercentileRecorder recorder;
    recorder.add(-3.5);
    const Percentiles p = recorder.summary();
    EXPECT_EQ(p.count, 1u);
    EXPECT_EQ(p.p50, -3.5);
    EXPECT_EQ(p.p99, -3.5);
    EXPECT_EQ(p.max, -3.5) << "also below zero";
}

TEST(Percentiles, AreTheNearestRanksWhateverTheOrder) {
    PercentileRecorder recorder;
    for (int i = 0; i <= 100; ++i) recorder.add((i * 37) % 101);
    const Percentiles p = recorder.summary();
    EXPECT_EQ(p.count, 101u);
    EXPECT_EQ(p.p50, 50);
    EXPECT_EQ(p.p95, 95);
    EXPECT_EQ(p.p99, 99);
    EXPECT_EQ(p.max, 100);
}

TEST(Percentiles, CoverTheNewestSamplesAndCountAndMaxCoverAll) {
    PercentileRecorder recorder(10);
    recorder.add(1000);
    for (int i = 0; i < 25; ++i) recorder.add(i);
    const Percentiles p = recorder.summary();
    EXPECT_EQ(p.count, 26u);
    EXPECT_EQ(p.max, 1000);
    EXPECT_EQ(p.p99, 24);
    EXPECT_GE(p.p50, 19) << "of 15..24";
    EXPECT_LE(p.p50, 20);
}

TEST(Percentiles, IgnoreNaN) {
    PercentileRecorder recorder(3);
    for (const double sample : {1.0, std::nan(""), 2.0, 2.0, std::nan(""), 3.0, 2.0})
        recorder.add(sample);
    const Percentiles p = recorder.summary();
    EXPECT_EQ(p.count, 5u);
    EXPECT_EQ(p.p50, 2);
    EXPECT_EQ(p.p99, 3);
}

}  // namespace
}  // namespace vantage
