#pragma once

#include <string>

#include "rig_firmware/stereo/matcher.h"

namespace vantage {

/// The passes of a matcher's last match() as a table for people: runs, time, traffic, operations,
/// their sums, and what a Raspberry Pi would take by a model.
std::string pass_table(const Matcher& matcher);

}  // namespace vantage
