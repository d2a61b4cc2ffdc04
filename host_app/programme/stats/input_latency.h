#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>

#include "common/base/percentiles.h"
#include "common/base/time/time.h"

namespace vantage {

/// Measures input latency: from each operator input to the hand-over of the first frame with it.
/// Steps of the camera source are numbered from 1. Not thread-safe.
class InputLatency {
  public:
    /// Adds the earliest new input of a step. `only_flies`: it changes only the camera, so that a
    /// reprojection shows it as well.
    void saw(MonotonicTime input, std::uint64_t step, bool only_flies) {
        if (waiting_.size() < max_waiting) waiting_.push_back({input, step, only_flies});
    }
    /// Drops all inputs, since they change no frame.
    void drop() { waiting_.clear(); }
    /// Records the hand-over of a frame with the camera of one step that was rendered for another
    /// one, which is not later. The longest latency of the inputs in it counts; returns when that
    /// input came, or nothing if the frame shows no new input.
    std::optional<MonotonicTime> showed(std::uint64_t camera_step, std::uint64_t rendered_step,
                                        MonotonicTime now) {
        const auto is_shown = [&](const Input& input) {
            return input.step <= (input.only_flies ? camera_step : rendered_step);
        };
        const auto first = std::find_if(waiting_.begin(), waiting_.end(), is_shown);
        if (first == waiting_.end()) return std::nullopt;
        const MonotonicTime came = first->time;
        all_ms_.add(to_ms(now - came));
        std::erase_if(waiting_, is_shown);
        return came;
    }

    bool is_waiting() const { return !waiting_.empty(); }
    /// Whether an input waits that a reprojection cannot show.
    bool is_waiting_for_rendering() const {
        return std::any_of(waiting_.begin(), waiting_.end(),
                           [](const Input& input) { return !input.only_flies; });
    }

    Percentiles all_ms() const { return all_ms_.summary(); }

  private:
    /// Bound of the memory while no frame is handed over; the earliest inputs count.
    static constexpr std::size_t max_waiting = 100;

    struct Input {
        MonotonicTime time;
        std::uint64_t step;
        bool only_flies;
    };
    std::deque<Input> waiting_;  ///< from the earliest to the latest
    PercentileRecorder all_ms_;
};

}  // namespace vantage
