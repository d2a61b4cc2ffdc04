#include "host_app/desk/windows/key_guard.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

TEST(KeyGuardTest, ConfirmsTheSecondPressInTime) {
    KeyGuard guard;
    EXPECT_FALSE(guard.confirms("end?", 10));
    EXPECT_EQ(guard.question(11), "end?");
    EXPECT_TRUE(guard.confirms("end?", 12));
    EXPECT_EQ(guard.question(12), "") << "it is answered";
    EXPECT_FALSE(guard.confirms("end?", 12.1)) << "and asked again the next time";
}

TEST(KeyGuardTest, ForgetsAQuestionAfterItsTime) {
    KeyGuard guard;
    EXPECT_FALSE(guard.confirms("end?", 10));
    EXPECT_EQ(guard.question(10 + KeyGuard::asks_for_s), "");
    EXPECT_FALSE(guard.confirms("end?", 10 + KeyGuard::asks_for_s));
}

TEST(KeyGuardTest, ANewQuestionReplacesTheFirst) {
    KeyGuard guard;
    EXPECT_FALSE(guard.confirms("end?", 10));
    EXPECT_FALSE(guard.confirms("replace?", 11));
    EXPECT_FALSE(guard.confirms("end?", 12));
    EXPECT_TRUE(guard.confirms("end?", 13));
}

}  // namespace
}  // namespace vantage
