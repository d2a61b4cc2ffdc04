#include "common/base/memory_pressure.h"

#include <filesystem>

#include <gtest/gtest.h>

namespace vantage {
namespace {

TEST(MemoryPressure, IsTheShareInWhichSomeProgramWaits) {
    EXPECT_DOUBLE_EQ(parse_memory_pressure("some avg10=12.50 avg60=3.00 avg300=1.00 total=99\n"
                                           "full avg10=2.00 avg60=1.00 avg300=0.00 total=9\n")
                         .value(),
                     0.125);
    EXPECT_EQ(parse_memory_pressure(""), std::nullopt);
    EXPECT_EQ(parse_memory_pressure("avg10=12.50"), std::nullopt);
}

TEST(MemoryPressure, IsKnownWhereTheKernelSaysIt) {
    EXPECT_EQ(memory_pressure().has_value(), std::filesystem::exists("/proc/pressure/memory"));
}

TEST(MemoryPressure, IsAWorryOnlyWhenAShowSuffers) {
    EXPECT_EQ(memory_worry(std::nullopt), "");
    EXPECT_EQ(memory_worry(0.01), "");
    EXPECT_EQ(memory_worry(0.34),
              "this computer is short of memory: programs waited for it in 34 % of the last 10 s");
}

}  // namespace
}  // namespace vantage
