#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/receive/rig_link.h"
#include "host_app/takes/bandwidth_budget.h"
#include "host_app/takes/fetched_files.h"
#include "host_app/takes/pulse_range.h"

namespace vantage {

/// What became of the fetch from one rig.
struct FetchStats {
    std::string rig;
    std::uint64_t wanted = 0;    ///< pulses that were asked of the rig
    std::uint64_t frames = 0;    ///< that came
    std::uint64_t not_kept = 0;  ///< pulses that the rig has no frame of either
    std::uint64_t there = 0;     ///< pulses that were there already
    std::uint64_t bytes = 0;
    std::uint64_t seen = 0;  ///< of `wanted`: came, or are known not to be kept
    std::vector<std::filesystem::path> files;
    std::string trouble;  ///< one sentence: why it came to an end; empty: all is here
    bool is_done = false;
};

/// Brings the frames that one rig keeps and this host lacks, in the order of their pulses. A
/// connection that breaks off is taken up where it was. Lives on one thread.
class RigFetch {
  public:
    /// What of the rig is wanted and not here, in order, by what its clock is from UTC.
    using Plan = std::function<std::vector<PulseRange>(int tai_offset_s)>;

    /// `patience`: with a rig that does not answer.
    RigFetch(zmq::context_t& context, const StageConfig::Rig& rig,
             const std::optional<CurveKeys>& host_keys, double rate_hz, Plan plan,
             FetchedFiles files, std::chrono::nanoseconds patience);

    RigLink& link() { return link_; }
    /// Takes in what came, and asks for more where `budget` allows. Throws Error if the disk fails.
    void turn(BandwidthBudget& budget, MonotonicTime now);
    /// Closes the file at hand.
    void finish();
    const FetchStats& stats() const { return stats_; }

  private:
    void take_in(const RigLink::Delivery& delivery, BandwidthBudget& budget);
    void look_at(const RigLink::View& view, MonotonicTime now);
    void ask_anew();
    void next_part();
    void end(std::string trouble);

    RigLink link_;
    double rate_hz_;
    Plan plan_;
    FetchedFiles files_;
    std::chrono::nanoseconds patience_;
    std::optional<std::deque<PulseRange>> parts_;  ///< still to come, the first is under way
    std::optional<FetchRequest> request_;
    std::uint64_t received_ = 0;  ///< for the wish
    std::uint64_t next_pulse_ = 0;
    double expected_bytes_ = 0;  ///< of a frame: the last one's
    std::optional<MonotonicTime> silent_since_;
    FetchStats stats_;
};

}  // namespace vantage
