#pragma once

namespace vantage {

/// Simulates a GPU reset for this program: all existing robust contexts report it from now on and
/// draw nothing. Contexts created later work.
void reset_gpu();

}  // namespace vantage
