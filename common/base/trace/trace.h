#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>

#include "common/base/time/time.h"

namespace vantage {

/// Place of a span in a flow: an arrow from span to span that follows one thing through threads.
enum class TraceFlow : char { begins = 's', passes = 't', ends = 'f' };

/// Identity of something that passes through several threads. Two kinds never share one.
class TraceId {
  public:
    constexpr TraceId() = default;
    static constexpr TraceId of_frame_set(std::uint64_t pulse) { return {1, pulse}; }
    static constexpr TraceId of_step(std::uint64_t step) { return {2, step}; }
    static constexpr TraceId of_tick(std::uint64_t tick) { return {3, tick}; }
    static TraceId of_input(MonotonicTime arrival) {
        return {4, static_cast<std::uint64_t>(to_ns(arrival))};
    }
    static constexpr TraceId of_rig_frame(std::uint64_t rig, std::uint64_t pulse) {
        constexpr int rig_bits = 8;
        return {5, (pulse << rig_bits) | (rig & 0xff)};
    }
    constexpr std::uint64_t value() const { return value_; }

  private:
    constexpr TraceId(std::uint64_t kind, std::uint64_t number)
        : value_((kind << 56) | (number & 0xff'ffff'ffff'ffff)) {}

    std::uint64_t value_ = 0;
};

/// A finished span as it waits for the file.
struct TraceEvent {
    struct Flow {
        std::uint64_t id = 0;  ///< 0: none
        TraceFlow place = TraceFlow::passes;
    };
    const char* name = nullptr;
    const char* value_name = nullptr;  ///< null: it has no value
    std::int64_t value = 0;
    std::int64_t begin_ns = 0, length_ns = 0;  ///< of MonotonicClock
    std::array<Flow, 4> flows{};
};

namespace trace_detail {
/// True while a TraceFile records.
inline std::atomic<bool> is_recording = false;
void record(const TraceEvent& event);
}  // namespace trace_detail

/// Records the time from construction to destruction as a span on this thread's track, while a
/// TraceFile records; otherwise it costs one relaxed load. It never waits and allocates memory only
/// at a thread's first span. Spans of a thread are nested or apart.
class TraceSpan {
  public:
    /// `name` must be a literal.
    explicit TraceSpan(const char* name) {
        if (trace_detail::is_recording.load(std::memory_order_relaxed)) begin(name);
    }
    ~TraceSpan() { end(); }
    TraceSpan(const TraceSpan&) = delete;
    TraceSpan& operator=(const TraceSpan&) = delete;

    /// Adds a value that the viewer shows with the span. `name` must be a literal.
    TraceSpan& with(const char* name, std::int64_t value) {
        event_.value_name = name;
        event_.value = value;
        return *this;
    }
    /// Makes the span a part of a flow; of four at most.
    TraceSpan& in(TraceId flow, TraceFlow place) {
        for (TraceEvent::Flow& free : event_.flows) {
            if (free.id != 0) continue;
            free = {flow.value(), place};
            break;
        }
        return *this;
    }
    /// Ends the span before its scope does.
    void end() {
        if (!event_.name) return;
        event_.length_ns = to_ns(MonotonicClock::now()) - event_.begin_ns;
        trace_detail::record(event_);
        event_.name = nullptr;
    }
    /// Ends the span and drops it if it was shorter, so that usual waits of no length stay out.
    void end_unless_shorter(std::chrono::nanoseconds least) {
        if (event_.name && to_ns(MonotonicClock::now()) - event_.begin_ns < least.count())
            event_.name = nullptr;
        end();
    }

  private:
    void begin(const char* name) {
        event_.name = name;
        event_.begin_ns = to_ns(MonotonicClock::now());
    }

    TraceEvent event_;
};

/// Names this thread's track, where several threads share a name. Without it the track has the name
/// of name_this_thread().
void name_trace_track(const std::string& name);

}  // namespace vantage
