#include "rig_firmware/trigger/edge_watcher.h"

#include "common/base/error.h"
#include "rig_firmware/trigger/line_request.h"

namespace vantage {

EdgeWatcher::EdgeWatcher(const RigConfig::Trigger& trigger)
    : line_(find_gpio_line(trigger)),
      request_(request_line(line_, gpiod::line_settings()
                                       .set_direction(gpiod::line::direction::INPUT)
                                       .set_active_low(trigger.active_low)
                                       .set_edge_detection(gpiod::line::edge::BOTH)
                                       .set_event_clock(gpiod::line::clock::MONOTONIC))) {}

std::optional<EdgeWatcher::Edge> EdgeWatcher::next(std::chrono::nanoseconds timeout) {
    try {
        if (!request_.wait_edge_events(timeout)) return std::nullopt;
        request_.read_edge_events(buffer_, 1);
    } catch (const std::exception& error) {
        fail("{} cannot be watched any more: {}", line_.text(), error.what());
    }
    const gpiod::edge_event& event = buffer_.get_event(0);
    Edge edge;
    edge.time = monotonic_from_ns(static_cast<std::int64_t>(event.timestamp_ns().ns()));
    // Edges refer to the logical level; active_low has already inverted it.
    edge.leading = event.type() == gpiod::edge_event::event_type::RISING_EDGE;
    if (last_number_) edge.lost = event.line_seqno() - *last_number_ - 1;
    last_number_ = event.line_seqno();
    return edge;
}

}  // namespace vantage
