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

/// Connects to all rigs of a stage, decodes their frames on threads of its own, and joins them by
/// trigger index. Rigs may come, go and come back at any time. A host that is slower than its rigs
/// makes them drop, oldest first, before anything crosses the network. Thread-safe.
class StageReceiver {
  public:
    enum class Purpose {
        film,       ///< asks every rig for its frames and starts the stage's take
        calibrate,  ///< as film, but for raw pairs instead of views
        look_on,    ///< asks for none until ask() does, and leaves the take to the host that films
        report      ///< as look_on, for who says itself what is wrong with a rig: warns of nothing
    };

    /// Throws Error if a key or an endpoint is unusable. Whatever `tap` uses must outlive this.
    explicit StageReceiver(const StageConfig& stage, Purpose purpose = Purpose::film,
                           FrameTap tap = {});
    ~StageReceiver();

    /// The next closed set, oldest first, within bounded memory; empty when the time is up.
    std::optional<FrameSet> next(std::chrono::nanoseconds timeout);
    ReceiverStatus status() const;

    /// Asks a rig to send nothing (streaming = false), or only every rate_divisor-th pulse. Throws
    /// Error for a rig that is not of the stage or a divisor outside 1..max_rate_divisor.
    void ask(std::string_view rig, bool streaming, std::uint32_t rate_divisor);

    /// Whether the pictures of a rig's frames are decoded, as they are at first. Where not, its
    /// frames are in sets as they came (RigFrame::has_pictures()), for what keeps them. Throws
    /// Error for a rig that is not of the stage.
    void look_at(std::string_view rig, bool is_looked_at);

    /// Asks every rig to say how it is, for help (JSON).
    void ask_for_reports();
    /// What the rig of this number said; null: nothing yet. An older rig never does.
    std::shared_ptr<const std::string> report_of(std::size_t rig) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vantage
