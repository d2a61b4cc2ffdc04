#pragma once

#include <numbers>

namespace vantage {

/// A whole turn in radians.
inline constexpr float tau = 2 * std::numbers::pi_v<float>;

}  // namespace vantage
