#pragma once

namespace vantage {

/// Neighbouring depths of one rig that differ by more than this ratio lie on two surfaces.
inline constexpr float depth_edge_ratio = 1.04f;

}  // namespace vantage
