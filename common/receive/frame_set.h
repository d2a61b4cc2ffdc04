#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/base/time/time.h"
#include "common/wire/frame_message.h"

namespace vantage {

/// Why a rig's frame is missing from a frame set.
enum class Absence {
    none,
    late,            ///< no frame of this pulse, or a later one, came within the latency budget
    missed_by_rig,   ///< the rig went on to later pulses without this one
    disconnected,    ///< the rig is silent
    unsynchronized,  ///< the rig's frames have no pulse of the stage, so they cannot be joined
                     ///< with another rig's
    not_asked,       ///< this host asked the rig for no frames, or for none of this pulse
    out_of_step,     ///< the rig counts pulses differently from the rest of the stage
};

/// The frames of all rigs at one pulse, as far as they came within the latency budget.
struct FrameSet {
    struct Slot {
        std::string rig;
        std::shared_ptr<const RigFrame> frame;  ///< null: absent
        Absence absence = Absence::none;
    };
    std::uint64_t trigger_index = 0;
    std::vector<Slot> slots;   ///< one per rig, in the order of stage.toml
    MonotonicTime complete{};  ///< when the frame set was closed

    int present() const {
        int n = 0;
        for (const Slot& slot : slots) n += slot.frame != nullptr;
        return n;
    }
};

}  // namespace vantage
