#pragma once

#include <filesystem>
#include <string>

#include "host_app/replay/clip.h"

namespace vantage {

/// Reads a clip file (docs/replay.md shows every key). Throws Error with file and line for whatever
/// does not fit, also for one of another pulse rate.
ClipBook load_clips(const std::filesystem::path& path, double pulse_rate_hz);

/// As a clip file: what load_clips() reads again.
std::string to_toml(const ClipBook& book);

}  // namespace vantage
