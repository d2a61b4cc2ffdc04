#include <gtest/gtest.h>

#include "tests/support/child_program.h"

namespace vantage {
namespace {

TEST(JogList, PrintsSomethingWithoutAnyDevice) {
    const ProgramResult listed = run_to_end(VANTAGE_PROGRAM, {"jog", "list", "--all"});
    EXPECT_EQ(listed.status, 0) << listed.err;
    EXPECT_FALSE(listed.out.empty());
}

}  // namespace
}  // namespace vantage
