#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "common/receive/stage_receiver.h"

namespace vantage {

/// Where frame sets come from: a StageReceiver, or something that stands for one.
struct StageFeed {
    std::function<std::optional<FrameSet>(std::chrono::nanoseconds)> next;
    std::function<ReceiverStatus()> status;
    /// Asks a rig to send frames or to stop sending them; none: nobody can be asked.
    std::function<void(const std::string& rig, bool streaming)> ask = {};
    /// Says whether a rig's pictures are looked at or only kept; none: all are looked at.
    std::function<void(const std::string& rig, bool is_looked_at)> look_at = {};
};
/// The receiver must outlive the feed.
StageFeed feed_of(StageReceiver& receiver);

}  // namespace vantage
