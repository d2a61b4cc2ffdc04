#include "common/base/cli/reload_signal.h"

#include <csignal>
#include <cstdlib>

#include <gtest/gtest.h>
#include <unistd.h>

namespace vantage {
namespace {

/// Ends with 0 if SIGHUP asked for a reload once each time. A new session has no terminal.
[[noreturn]] void take_hangups() {
    ::setsid();
    ReloadSignal signal;
    if (signal.take()) std::_Exit(1);
    std::raise(SIGHUP);
    std::raise(SIGHUP);
    if (!signal.take()) std::_Exit(2);
    if (signal.take()) std::_Exit(3);
    std::_Exit(0);
}

TEST(ReloadSignalDeathTest, IsTakenWithoutATerminal) {
    EXPECT_EXIT(take_hangups(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace vantage
