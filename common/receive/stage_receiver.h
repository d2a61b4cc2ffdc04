#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/config/stage_config.h"
#include "common/receive/frame_set.h"
#include "common/receive/rig_status.h"
#include "common/wire/arrived_frame.h"

namespace vantage {

/// Connects to all rigs of a stage, decodes their frames on threads of its own, and joins them into
/// frame sets by trigger index. Rigs may come, go and return at any time. If the host is slower
/// than its rigs, the rigs drop frames, oldest first, before they cross the network. Thread-safe.
class StageReceiver {
  public:
    enum class Purpose {
        film,       ///< asks every rig for its frames and starts the stage's trigger pulses
        calibrate,  ///< like film, but for raw pairs instead of views
        observe,    ///< asks for no frames until ask(), and starts no pulses
        report      ///< like observe, and logs no warnings, for callers that report faults
    };

    /// Throws Error if a key or an endpoint is invalid. `tap` is called on the I/O thread.
    explicit StageReceiver(const StageConfig& stage, Purpose purpose = Purpose::film,
                           FrameTap tap = {});
    ~StageReceiver();

    /// Waits for the next closed frame set, oldest first; empty after the timeout. A bounded number
    /// of frame sets waits; newer ones replace the oldest.
    std::optional<FrameSet> next(std::chrono::nanoseconds timeout);
    /// The rigs of the stage in its order, and then those that reload() has removed.
    ReceiverStatus status() const;

    /// A changed stage with the connections that it needs, for follow().
    class Update {
      public:
        Update(Update&&) noexcept;
        ~Update();
        /// The rigs' names by their numbers. A rig keeps its number also while it is removed.
        const std::vector<std::string>& names() const;

      private:
        friend class StageReceiver;
        struct Content;
        explicit Update(std::unique_ptr<Content> content);
        std::unique_ptr<Content> content_;
    };
    /// Prepares to follow a changed stage. Throws Error if a key or an endpoint is invalid.
    Update prepare(const StageConfig& stage) const;
    /// Follows a changed stage: disconnects rigs that it names no longer, connects to new ones, and
    /// connects anew where an endpoint or a key has changed. Other rigs are left as they are. The
    /// counts of all rigs continue. The latency budget applies to the frame sets that open next;
    /// the stage's rate stays. `update` is the last one that was prepared.
    void follow(Update update);

    /// Asks a rig to send nothing (streaming = false), or only every rate_divisor-th pulse. Has no
    /// effect on a removed rig. Throws Error for an unknown rig or a divisor outside
    /// 1..max_rate_divisor.
    void ask(std::string_view rig, bool streaming, std::uint32_t rate_divisor);

    /// Sets whether a rig's images are decoded, which is the default. If not, frame sets contain
    /// its frames in packed form (RigFrame::has_pictures()), for recording. Throws Error for an
    /// unknown rig.
    void set_decoded(std::string_view rig, bool is_decoded);

    /// Asks every rig for a report for bug reports (JSON).
    void ask_for_reports();
    /// The report of a rig by its number; null: none yet. Older rigs never send one.
    std::shared_ptr<const std::string> report_of(std::size_t rig) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vantage
