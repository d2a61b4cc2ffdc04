#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/base/percentiles.h"
#include "common/base/time/time.h"

namespace vantage {

/// Inputs of hands, each until the first picture with it is handed over. Whoever flies is asked in
/// looks, which are numbered from 1 on.
class InputLatency {
  public:
    /// The earliest input that is new in this look. `only_flies`: it changes nothing but the
    /// camera, so that a picture which was carried on to that shows it.
    void saw(MonotonicTime input, std::uint64_t look, bool only_flies);
    /// What is waited for changes no picture.
    void drop() { waiting_.clear(); }
    /// A picture from the camera of one look, rendered of another one, which is no later, is handed
    /// over. The longest that an input waited for it counts.
    void showed(std::uint64_t camera_look, std::uint64_t rendered_look, MonotonicTime now);

    bool is_waiting() const { return !waiting_.empty(); }
    /// For a picture that is rendered with an input.
    bool is_waiting_for_rendering() const;

    Percentiles all_ms() const { return all_ms_.summary(); }

  private:
    struct Input {
        MonotonicTime time;
        std::uint64_t look;
        bool only_flies;
    };
    std::deque<Input> waiting_;  ///< from the earliest to the latest
    PercentileRecorder all_ms_;
};

}  // namespace vantage
