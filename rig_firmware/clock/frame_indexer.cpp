#include "rig_firmware/clock/frame_indexer.h"

#include <algorithm>

namespace vantage {
namespace {

/// A frame that comes later than so many pulses after its own is lost to its pulse.
constexpr std::size_t remembered_pulses = 256;
/// Indices that fall back by more were set back with the clock.
constexpr std::uint64_t clock_step_pulses = 2;

bool is_near(std::chrono::nanoseconds apart, std::chrono::nanoseconds period) {
    return apart < period / 4 && -apart < period / 4;
}

}  // namespace

void FrameIndexer::sent(std::uint64_t index) {
    if (!pulses_.empty() && pulses_.back() == index) return;
    pulses_.push_back(index);
    ++pulse_count_;
    if (pulses_.size() > remembered_pulses) pulses_.pop_front();
}

bool FrameIndexer::seen(TaiTime edge) {
    const std::uint64_t index = grid_.nearest_index(edge);
    if (!is_near(edge - grid_.time_of(index), grid_.period())) {
        ++stray_edges_;
        return false;
    }
    if (!pulses_.empty() && index > pulses_.back()) missing_edges_ += index - pulses_.back() - 1;
    sent(index);
    return true;
}

void FrameIndexer::clock_was_set() {
    pulses_.clear();
    last_.reset();
}

std::optional<std::uint64_t> FrameIndexer::index_of(TaiTime stamp) {
    const TaiTime pulse = stamp - delay_;
    const std::uint64_t index = grid_.nearest_index(pulse);
    const bool was_pulsed = std::find(pulses_.begin(), pulses_.end(), index) != pulses_.end();
    if (!was_pulsed || !is_near(pulse - grid_.time_of(index), grid_.period())) {
        ++unsynchronized_;
        return std::nullopt;
    }
    if (last_ && index <= *last_ && *last_ - index <= clock_step_pulses) {
        ++duplicates_;
        ++unsynchronized_;
        return std::nullopt;
    }
    if (last_ && index > *last_) missed_ += index - *last_ - 1;
    last_ = index;
    return index;
}

}  // namespace vantage
