#include "host_app/frames/stage_feed.h"

namespace vantage {

StageFeed feed_of(StageReceiver& receiver) {
    return {
        [&receiver](std::chrono::nanoseconds timeout) { return receiver.next(timeout); },
        [&receiver] { return receiver.status(); },
        [&receiver](const std::string& rig, bool streaming) { receiver.ask(rig, streaming, 1); },
        [&receiver](const std::string& rig, bool is_looked_at) {
            receiver.set_decoded(rig, is_looked_at);
        }};
}

}  // namespace vantage
