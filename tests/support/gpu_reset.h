#pragma once

namespace vantage {

/// Simulates a GPU reset for this program: all existing robust contexts report it from now on and
/// draw nothing. Contexts created later work.
void reset_gpu();

/// Lets the GPU hang for this program: no fence of an existing context is reached any more, and a
/// wait for one uses up its limit at once. No driver reports it, and the renderer claims to be no
/// software. Contexts created later work.
void hang_gpu();

}  // namespace vantage
