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
    PublisherStatus publisher;  ///< its rig counters are the daemon's whole book
    std::vector<SourceCounter> source_counters;
    RigSync sync;
    /// What the daemon does before its first frame ("compiling shaders, 7 of 21"); empty: it works.
    std::string starting;
    std::string keeps;  ///< of the rig's own take, one line; empty: it keeps none
    std::uint64_t kept_files_erased = 0;
    Percentiles capture_ms;  ///< exposure to delivered
    Percentiles rectify_ms;  ///< upload, rectify
    Percentiles match_ms;    ///< match, read back
    Percentiles pack_ms;     ///< encode, hand to the publisher
    Percentiles latency_ms;  ///< exposure to handed to the publisher
};

/// The road of a rig: capture -> GPU (rectify, match) -> pack and publish, a thread each. Between
/// two of them waits at most one frame; a newer one takes its place, and the old one is counted as
/// late. Hosts are served from the start; capturing begins once the GPU's shaders are compiled. A
/// GPU that was reset or hangs is counted (source counter "gpu_restarts") and set up anew. At every
/// stop
///     captured = published + late.
class RigDaemon {
  public:
    /// Returns once hosts can connect, while shaders may still be compiled. Throws Error for
    /// whatever of the config cannot be had; what the GPU refuses ends the daemon later. It ends by
    /// itself after `frame_limit` published frames, if that is not 0.
    explicit RigDaemon(const RigConfig& config, std::uint64_t frame_limit = 0);
    /// Stops the road; frames under way are finished or counted.
    ~RigDaemon();

    /// False once the source has come to its end and every frame is through, the limit is reached,
    /// or a part has failed.
    bool running() const;
    /// Throws the Error that ended the road, if one did.
    void rethrow_failure() const;
    void stop();
    /// The thread that has not come round its loop for the longest time, if that is longer than
    /// `limit`; empty if all have. Locks nothing that such a thread could hold.
    std::string stuck_worker(std::chrono::nanoseconds limit) const;

    DaemonStatus status() const;
    /// Where hosts connect, with the port that was bound.
    std::string endpoint() const;
    /// Lines for the start-up report.
    std::vector<std::string> report() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vantage
