#include "common/receive/credit_window.h"

#include <gtest/gtest.h>

#include "common/wire/limits.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

TEST(CreditWindow, IsAFewFramesOnAShortWay) {
    EXPECT_EQ(credit_window(0us, 25, false), 4u);
    EXPECT_EQ(credit_window(500us, 60, false), 4u);
    EXPECT_EQ(credit_window(500us, 0, false), 4u);
}

TEST(CreditWindow, CoversTheRoundTripAtTheRigsRate) {
    EXPECT_EQ(credit_window(100ms, 50, false), 9u);
    EXPECT_EQ(credit_window(200ms, 25, false), 9u);
    EXPECT_GT(credit_window(100ms, 0, false), credit_window(100ms, 25, false))
        << "an unknown rate may be a high one";
}

TEST(CreditWindow, CoversARepeatedCreditWithDatagrams) {
    EXPECT_EQ(credit_window(20ms, 25, true), 30u);
    EXPECT_GT(credit_window(1ms, 25, true), credit_window(1ms, 25, false));
}

TEST(CreditWindow, IsNoMoreThanARigGrants) {
    EXPECT_EQ(credit_window(5s, 120, false), max_credit_window);
    EXPECT_EQ(credit_window(100ms, 120, true), max_datagram_credit_window);
}

}  // namespace
}  // namespace vantage
