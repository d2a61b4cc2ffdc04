#include "host_app/output/set_timecode.h"

namespace vantage {

std::string SetTimecode::of(const FrameSet& set) const {
    for (const FrameSet::Slot& slot : set.slots)
        if (slot.frame)
            return clock_.at(pulses_.time_of(set.trigger_index), slot.frame->sync.tai_offset_s);
    return {};
}

}  // namespace vantage
