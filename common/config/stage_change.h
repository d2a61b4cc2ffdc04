#pragma once

#include <string>
#include <vector>

#include "common/config/stage_config.h"

namespace vantage {

/// The difference between the stage of a running show and a changed stage file.
struct StageChange {
    std::vector<std::string> added, removed;  ///< names of rigs
    std::vector<std::string> moved;           ///< rigs with another endpoint
    std::vector<std::string> rekeyed;         ///< rigs with another public key
    std::vector<std::string> recoloured;      ///< rigs with another colour file
    bool has_new_order = false;               ///< of the rigs that stay
    bool has_new_latency_budget = false;
    /// Keys of the file that changed and apply from the next start only, such as "rate_hz".
    std::vector<std::string> left;
};

/// Compares the stage of a running show with a changed stage file.
StageChange stage_change(const StageConfig& running, const StageConfig& file);

/// The stage that a running show goes on with: that of the file, with the running values of the
/// keys that apply from the next start only.
StageConfig stage_to_go_on_with(const StageConfig& running, const StageConfig& file);

/// Describes the change in a sentence: "added rig west; removed rig north". `has_new_host_key`:
/// this host's own key has changed.
std::string text_of(const StageChange& change, bool has_new_host_key);

}  // namespace vantage
