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
    std::vector<std::string> rigs;   ///< names of the rigs that send images
    double pictures_per_second = 2;  ///< maximum for each rig
    std::chrono::seconds patience{30};
};

/// Unrectified images of one rig.
struct RawPair {
    ColourImage left, right;
    std::string calibration_id;  ///< calibration that the rig uses; empty: none yet
};

/// Raw pairs of one pulse, one for every rig in the order of the options; empty for a rig that sent
/// none.
struct LiveInstant {
    std::uint64_t pulse = 0;
    std::vector<std::optional<RawPair>> pairs;
    bool is_complete() const;
};

/// Client of running rigs that receives raw pairs by pulse, over the same authenticated links as
/// the host. During its lifetime SIGINT and SIGTERM end the film, not the program. Rigs continue to
/// serve views to hosts at the same time. Use it from one thread.
class LiveRigs {
  public:
    /// Throws Error for an invalid stage file, and for rig names that it does not contain.
    explicit LiveRigs(const LiveOptions& options);
    ~LiveRigs();

    /// Next pulse with a pair of any rig; empty once the program is asked to stop. Throws Error
    /// with the state of every rig if none arrives in time.
    std::optional<LiveInstant> next();

    /// Next pulse with a pair of every rig. Throws Error with the missing rigs if none arrives in
    /// time.
    std::optional<LiveInstant> next_complete();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vantage
