#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/image/image.h"

namespace vantage {

struct LiveOptions {
    std::filesystem::path stage_file;
    std::vector<std::string> rigs;   ///< names of those that are asked for pictures
    double pictures_per_second = 2;  ///< of each rig, at most
    std::chrono::seconds patience{30};
};

/// What the sensors of one rig saw, not rectified.
struct RawPair {
    ColourImage left, right;
    std::string calibration_id;  ///< that the rig works with; empty: none yet
};

/// One pulse; a pair for every rig, in the order of the options, empty where none came.
struct LiveInstant {
    std::uint64_t pulse = 0;
    std::vector<std::optional<RawPair>> pairs;
    bool is_complete() const;
};

/// Running rigs of a stage, as sources of raw pairs by pulse over the authenticated links that the
/// host uses too. While it lives, SIGINT and SIGTERM end the film and not the program. Rigs that
/// are asked for views at the same time go on serving them.
class LiveRigs {
  public:
    /// Throws Error for a stage file that cannot be used and names that it has not.
    explicit LiveRigs(const LiveOptions& options);
    ~LiveRigs();

    /// The next instant of which any rig's pair came; empty once the program is asked to stop.
    /// Throws Error, saying what is known of every rig, if none comes for as long as the patience.
    std::optional<LiveInstant> next();

    /// The next instant of which every rig's pair came. Throws Error naming the rigs that are
    /// missing if there is none for as long as the patience.
    std::optional<LiveInstant> next_complete();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vantage
