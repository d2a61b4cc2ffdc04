#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/base/percentiles.h"
#include "common/config/rig_config.h"
#include "rig_firmware/capture/stereo_source.h"
#include "rig_firmware/stream/publisher.h"

namespace vantage {

struct DaemonStatus {
    PublisherStatus publisher;  ///< its rig counters are the complete counts of the daemon
    std::vector<SourceCounter> source_counters;
    RigSync sync;
    /// Start-up step before the first frame ("compiling shaders, 7 of 21"); empty once frames flow.
    std::string starting;
    std::string
        keeps;  ///< status of the rig's own recording in one line; empty if it records nothing
    std::uint64_t kept_files_erased = 0;
    Percentiles capture_ms;  ///< from exposure until the source delivers
    Percentiles rectify_ms;  ///< upload and rectify
    Percentiles match_ms;    ///< match and read back
    Percentiles pack_ms;     ///< encode and pass to the publisher
    Percentiles latency_ms;  ///< from exposure until the publisher has the frame
};

/// Pipeline of a rig: capture -> GPU (rectify, match) -> pack and publish, with one thread for
/// each. At most one frame waits between two stages; a newer frame replaces it, and the old one is
/// counted as late. Hosts are served from the start; capture begins once the GPU's shaders are
/// compiled. A GPU that was reset or hangs is counted (source counter "gpu_restarts") and
/// initialised again. After every stop
///     captured = published + late.
class RigDaemon {
  public:
    /// Returns once hosts can connect, while shaders may still be compiled. Throws Error if a part
    /// of the configuration is not available; a GPU error ends the daemon later. The daemon ends by
    /// itself after `frame_limit` published frames; 0 means no limit.
    explicit RigDaemon(const RigConfig& config, std::uint64_t frame_limit = 0);
    /// Stops the pipeline; frames in progress are finished or counted as late.
    ~RigDaemon();

    /// False once the source has ended and every frame has passed, the limit is reached, or a part
    /// has failed.
    bool running() const;
    /// Throws the Error that ended the pipeline, if there is one.
    void rethrow_failure() const;
    void stop();
    /// Name of the thread that has not passed its loop for the longest time, if that time exceeds
    /// `limit`; else empty. Takes no lock that a stuck thread could hold.
    std::string stuck_worker(std::chrono::nanoseconds limit) const;

    DaemonStatus status() const;
    /// Endpoint that hosts connect to, with the port that was bound.
    std::string endpoint() const;
    /// Lines for the start-up report.
    std::vector<std::string> report() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vantage
