#include <csignal>

#include "tests/support/gpu_reset.h"

// For LD_PRELOAD into a program of Vantage: SIGUSR2 resets its GPU, SIGUSR1 lets it hang.

namespace {

void reset(int /*signal*/) { vantage::reset_gpu(); }
void hang(int /*signal*/) { vantage::hang_gpu(); }

[[gnu::constructor]] void listen() {
    std::signal(SIGUSR2, reset);
    std::signal(SIGUSR1, hang);
}

}  // namespace
