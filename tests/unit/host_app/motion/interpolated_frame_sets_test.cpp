#include "host_app/foreground/motion/interpolated_frame_sets.h"

#include <map>

#include <gtest/gtest.h>

namespace vantage {
namespace {

/// Sets of one rig whose picture is all one grey, that of its pulse; counts how often it is asked.
class GreyFrameSets final : public PastFrameSets {
  public:
    explicit GreyFrameSets(std::vector<std::uint64_t> pulses) : pulses_(std::move(pulses)) {}
    std::optional<std::uint64_t> pulse_at(double pulse) const override {
        std::optional<std::uint64_t> found;
        for (const std::uint64_t each : pulses_)
            if (static_cast<double>(each) <= pulse) found = each;
        return found ? found : pulses_.front();
    }
    std::optional<FrameSet> at(double pulse) const override {
        FrameSet set;
        set.trigger_index = *pulse_at(pulse);
        ++asked[set.trigger_index];
        auto frame = std::make_shared<RigFrame>();
        const auto grey = static_cast<unsigned char>(20 * set.trigger_index);
        frame->colour = ColourImage(48, 64, cv::Vec4b(grey, grey, grey, 255));
        set.slots.push_back({"north", set.trigger_index == absent ? nullptr : frame});
        return set;
    }
    std::optional<Span> span() const override { return std::nullopt; }

    mutable std::map<std::uint64_t, int> asked;
    std::uint64_t absent = ~std::uint64_t{0};

  private:
    std::vector<std::uint64_t> pulses_;
};

int grey_of(const FrameSet& set) { return set.slots[0].frame->colour(24, 32)[0]; }

TEST(InterpolatedFrameSetsTest, InterpolatesBetweenThePulsesAroundAMoment) {
    const GreyFrameSets past({1, 2, 3});
    InterpolatedFrameSets between;
    const auto set = between.at(past, 1, 0.5);
    ASSERT_TRUE(set);
    EXPECT_EQ(set->trigger_index, 1u);
    EXPECT_NEAR(grey_of(*set), 30, 1);
}

TEST(InterpolatedFrameSetsTest, FetchesEveryFrameSetOnceInBothDirections) {
    const GreyFrameSets past({1, 2, 3, 4});
    InterpolatedFrameSets between;
    for (const std::uint64_t pulse : {1, 2, 3})
        for (const double share : {0.25, 0.5, 0.75}) ASSERT_TRUE(between.at(past, pulse, share));
    for (const auto& [pulse, times] : past.asked) EXPECT_EQ(times, 1) << pulse;
    for (const std::uint64_t pulse : {2, 1})
        for (const double share : {0.75, 0.5}) ASSERT_TRUE(between.at(past, pulse, share));
    EXPECT_EQ(past.asked.at(3), 1);
    EXPECT_LE(past.asked.at(2), 2);
    EXPECT_LE(past.asked.at(1), 2);
}

TEST(InterpolatedFrameSetsTest, ShowsThePulseBeforeAGap) {
    const GreyFrameSets past({1, 4});
    InterpolatedFrameSets between;
    EXPECT_EQ(grey_of(*between.at(past, 1, 0.5)), 20);
    EXPECT_FALSE(between.at(past, 2, 0.5));
}

TEST(InterpolatedFrameSetsTest, KeepsTheFirstFrameOfARigThatTheSecondLacks) {
    GreyFrameSets past({1, 2, 3});
    past.absent = 2;
    InterpolatedFrameSets between;
    EXPECT_EQ(grey_of(*between.at(past, 1, 0.5)), 20);
    EXPECT_EQ(between.at(past, 2, 0.5)->slots[0].frame, nullptr);
}

}  // namespace
}  // namespace vantage
