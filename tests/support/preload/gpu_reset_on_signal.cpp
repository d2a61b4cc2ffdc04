#include <csignal>

#include "tests/support/gpu_reset.h"

// For LD_PRELOAD into a program of Vantage: SIGUSR2 resets its GPU.

namespace {

void reset(int /*signal*/) { vantage::reset_gpu(); }

[[gnu::constructor]] void listen() { std::signal(SIGUSR2, reset); }

}  // namespace
