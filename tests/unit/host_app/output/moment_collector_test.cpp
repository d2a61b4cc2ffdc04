#include "host_app/output/moment_collector.h"

#include <string>

#include <gtest/gtest.h>

namespace vantage {
namespace {

std::vector<int> chosen_of(std::uint64_t pictures) {
    MomentCollector collector(4);
    for (std::uint64_t i = 0; i < pictures; ++i)
        if (collector.wants(i)) collector.add({std::to_string(i), {}, {}});
    std::vector<int> chosen;
    for (const Moment& moment : collector.chosen()) chosen.push_back(std::stoi(moment.title));
    return chosen;
}

TEST(MomentCollector, KeepsAllOfAShortFlight) {
    EXPECT_EQ(chosen_of(3), (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(chosen_of(0), std::vector<int>{});
}

TEST(MomentCollector, SpreadsEvenlyOverAnyLength) {
    for (std::uint64_t pictures = 5; pictures < 3000; pictures += 7) {
        const std::vector<int> chosen = chosen_of(pictures);
        ASSERT_EQ(chosen.size(), 4u);
        EXPECT_EQ(chosen[0], 0);
        const double step = static_cast<double>(chosen[3]) / 3;
        EXPECT_GT(chosen[3], 0.7 * static_cast<double>(pictures - 1)) << pictures;
        for (int i = 1; i < 3; ++i) EXPECT_NEAR(chosen[i], i * step, 0.35 * step) << pictures;
    }
}

}  // namespace
}  // namespace vantage
