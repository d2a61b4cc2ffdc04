#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/base/time/time.h"
#include "common/config/stage_config.h"
#include "common/receive/rig_link.h"
#include "common/take/kept_frame.h"
#include "common/take/take_reader.h"

namespace vantage {

/// Writes the frames fetched from one rig to takes in a folder. Each take has its final name from
/// the start, so that an interrupted fetch resumes. Not thread-safe.
class FetchedFiles {
  public:
    /// `show`: for TakeFacts. Takes that cannot be read are skipped and logged.
    FetchedFiles(std::filesystem::path folder, std::string rig, nlohmann::ordered_json show);
    /// Leaves the last file readable.
    ~FetchedFiles();
    FetchedFiles(FetchedFiles&&) = default;
    FetchedFiles& operator=(FetchedFiles&&) = delete;

    /// The pulses of frames that the folder had already, in order.
    const std::vector<std::uint64_t>& there() const { return there_; }
    /// Writes a frame to the current file, or to a new one if its images do not fit or its pulse is
    /// not later than the previous one. Throws Error if the disk fails.
    void add(const KeptFrame& frame);
    /// Closes the current file.
    void finish();

    const std::vector<std::filesystem::path>& files() const { return files_; }

  private:
    void begin(const KeptFrame& frame);

    std::filesystem::path folder_;
    std::string rig_;
    nlohmann::ordered_json show_;
    std::vector<std::uint64_t> there_;
    std::unique_ptr<TakeWriter> writer_;
    std::uint64_t last_pulse_ = 0;
    std::vector<std::filesystem::path> files_;
};

/// The pulses from `from` to before `to`.
struct PulseRange {
    std::uint64_t from = 0, to = 0;
    std::uint64_t pulses() const { return to > from ? to - from : 0; }
    bool operator==(const PulseRange&) const = default;
};

/// The parts of `whole` without the pulses `there`, which are sorted.
std::vector<PulseRange> missing_parts(PulseRange whole, std::span<const std::uint64_t> there);

/// Limits the rate of requested bytes: a token bucket that holds a quarter of a second's worth.
/// Clock readings are arguments. Not thread-safe.
class BandwidthBudget {
  public:
    explicit BandwidthBudget(double bytes_s) : bytes_s_(bytes_s) {}

    bool may_spend(MonotonicTime now) {
        fill(now);
        return bytes_ >= 0;
    }
    /// Takes bytes out of the bucket, which may become negative, since sizes are known on arrival
    /// only. Negative: returns an estimate that did not arrive.
    void spend(double bytes) { bytes_ -= bytes; }
    /// The time until the bucket is not empty.
    std::chrono::nanoseconds wait(MonotonicTime now) {
        fill(now);
        return std::chrono::nanoseconds(
            static_cast<std::int64_t>(std::max(0.0, -bytes_) / bytes_s_ * ns_per_s));
    }

  private:
    static constexpr double ns_per_s = 1e9, most_s = 0.25;
    void fill(MonotonicTime now) {
        if (filled_ != MonotonicTime{})
            bytes_ =
                std::min(most_s * bytes_s_,
                         bytes_ + bytes_s_ * std::chrono::duration<double>(now - filled_).count());
        filled_ = now;
    }

    double bytes_s_, bytes_ = 0;
    MonotonicTime filled_{};
};

/// The result of the fetch from one rig.
struct FetchStats {
    std::string rig;
    std::uint64_t wanted = 0;    ///< pulses requested from the rig
    std::uint64_t frames = 0;    ///< frames received
    std::uint64_t not_kept = 0;  ///< pulses that the rig has not recorded
    std::uint64_t there = 0;     ///< pulses that the folder or the take had already
    std::uint64_t bytes = 0;
    std::uint64_t seen = 0;  ///< of `wanted`: received, or known not to be recorded
    std::vector<std::filesystem::path> files;
    std::string trouble;  ///< why it ended early, in one sentence; empty: complete
    bool is_done = false;
};

/// Fetches the recorded frames of one rig that this host lacks, in the order of their pulses.
/// Continues after a reconnect. Used by one thread.
class RigFetch {
  public:
    /// The pulses to fetch, in order, for a rig's TAI offset.
    using Plan = std::function<std::vector<PulseRange>(int tai_offset_s)>;

    /// `patience`: the longest wait for a rig that does not answer.
    RigFetch(zmq::context_t& context, const StageConfig::Rig& rig,
             const std::optional<CurveKeys>& host_keys, double rate_hz, Plan plan,
             FetchedFiles files, std::chrono::nanoseconds patience);

    RigLink& link() { return link_; }
    /// Handles messages and requests more frames within `budget`. Throws Error if the disk fails.
    void turn(BandwidthBudget& budget, MonotonicTime now);
    /// Closes the current file.
    void finish();
    const FetchStats& stats() const { return stats_; }

  private:
    void take_in(const RigLink::Delivery& delivery, BandwidthBudget& budget);
    void check_link(const RigLink::View& view, MonotonicTime now);
    void ask_anew();
    void next_part();
    void end(std::string trouble);

    RigLink link_;
    double rate_hz_;
    Plan plan_;
    FetchedFiles files_;
    std::chrono::nanoseconds patience_;
    std::optional<std::deque<PulseRange>> parts_;  ///< still to fetch; the first is in progress
    std::optional<FetchRequest> request_;
    std::uint64_t received_ = 0;  ///< frames of the current request
    std::uint64_t next_pulse_ = 0;
    double expected_bytes_ = 0;  ///< size of the last frame
    std::optional<MonotonicTime> silent_since_;
    FetchStats stats_;
};

/// Fetches the rigs' own recordings to this host.
struct KeptFetch {
    /// The pulses to fetch, for a rig's TAI offset.
    std::function<PulseRange(int tai_offset_s)> range;
    std::shared_ptr<const TakeReader> take;  ///< its frames are not fetched; may be null
    std::vector<std::string> rigs;           ///< empty: all rigs of the stage
    std::filesystem::path folder;            ///< existing folder for the files
    double bytes_s = 20e6;                   ///< total rate limit
    std::chrono::nanoseconds patience = std::chrono::seconds(10);  ///< with a silent rig

    using Progress = std::function<void(const std::vector<FetchStats>&)>;
    /// Fetches from all rigs in parallel, and returns when each has sent all it has or failed, or
    /// when `is_stopped`. `progress` is called now and then. Throws Error for invalid keys,
    /// endpoints and names, and if the disk fails.
    std::vector<FetchStats> run(const StageConfig& stage, const std::function<bool()>& is_stopped,
                                const Progress& progress) const;
};

}  // namespace vantage
