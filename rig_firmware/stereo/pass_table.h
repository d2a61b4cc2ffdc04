#pragma once

#include <string>

#include "rig_firmware/stereo/matcher.h"

namespace vantage {

/// The passes of a matcher's last match() as a table for people: runs, time, traffic, operations,
/// and their sums.
std::string pass_table(const Matcher& matcher);

}  // namespace vantage
