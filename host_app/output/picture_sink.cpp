#include "host_app/output/picture_sink.h"

namespace vantage {

std::optional<int> tai_offset_s_of(const FrameSet& set) {
    for (const FrameSet::Slot& slot : set.slots)
        if (slot.frame) return slot.frame->sync.tai_offset_s;
    return std::nullopt;
}

std::string SetTimecode::of(const FrameSet& set) const {
    const std::optional<int> offset_s = tai_offset_s_of(set);
    return offset_s ? clock_.at(pulses_.time_of(set.trigger_index), *offset_s) : std::string();
}

}  // namespace vantage
