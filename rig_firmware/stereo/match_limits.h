#pragma once

#include "rig_firmware/stereo/matcher.h"

namespace vantage {

/// Throws Error that names the limit if `settings` is beyond what any matcher takes: 16..4096
/// pixels wide and high, 1..256 disparities.
void require_match_limits(const MatchSettings& settings);

}  // namespace vantage
