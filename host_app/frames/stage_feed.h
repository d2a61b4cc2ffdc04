#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "common/receive/stage_receiver.h"

namespace vantage {

/// Source of frame sets: a StageReceiver, or a substitute for one. Its functions are thread-safe.
struct StageFeed {
    /// The next frame set; empty after a timeout. Throws what stopped the source.
    std::function<std::optional<FrameSet>(std::chrono::nanoseconds)> next;
    std::function<ReceiverStatus()> status;
    /// Tells a rig to send frames or to stop sending; empty: the source has no rigs to tell.
    std::function<void(const std::string& rig, bool streaming)> ask = {};
    /// Reports whether frames of a rig are used at once or only stored; empty: all are used.
    std::function<void(const std::string& rig, bool is_looked_at)> look_at = {};
};

/// The receiver must outlive the feed.
inline StageFeed feed_of(StageReceiver& receiver) {
    return {
        [&receiver](std::chrono::nanoseconds timeout) { return receiver.next(timeout); },
        [&receiver] { return receiver.status(); },
        [&receiver](const std::string& rig, bool streaming) { receiver.ask(rig, streaming, 1); },
        [&receiver](const std::string& rig, bool is_looked_at) {
            receiver.set_decoded(rig, is_looked_at);
        }};
}

}  // namespace vantage
