#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/wire/frame_codec.h"

namespace vantage {

/// What programs of the scale bench leave in a folder for one another: keys, stage files, and at
/// the end what was counted, as JSON.
struct ScaleFolder {
    std::filesystem::path path;
    std::filesystem::path file(const char* name) const { return path / name; }
};

/// The frames of a take as the rigs sent them, a rig a vector. Throws Error if it has none.
std::vector<std::vector<PackedFrame>> frames_of_take(const std::filesystem::path& take);

struct ScaleRigs {
    std::filesystem::path take;  ///< that is replayed, again and again
    int rigs = 8;
    double rate_hz = 30, seconds = 10;
    int hosts = 1;  ///< that all have to be there before the first pulse
};
/// Serves so many rigs on free ports of loopback, each with socket, counters and keys as in the
/// rig's daemon. Writes stage.toml when they listen, and rigs.json at the end. Frames get their
/// pulse's number and nothing else: filming, matching and packing are other computers' work.
void serve_scale_rigs(const ScaleFolder& folder, const ScaleRigs& wanted);

/// Relays the rigs of stage.toml until rigs.json is there. Writes behind.toml when it listens, and
/// relay.json at the end.
void serve_scale_relay(const ScaleFolder& folder);

/// User and system time of this process, in seconds.
double cpu_s();

}  // namespace vantage
