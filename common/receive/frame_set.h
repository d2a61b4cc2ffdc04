#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/base/time/time.h"
#include "common/wire/frame_message.h"

namespace vantage {

/// Why a rig is not in a set.
enum class Absence {
    none,
    late,            ///< nothing of this pulse, or of a later one, came within the latency budget
    missed_by_rig,   ///< the rig went on to later pulses without this one
    disconnected,    ///< no sign of life from the rig
    unsynchronized,  ///< the rig's frames name no pulse of the stage, so they are fused with no
                     ///< other
    not_asked,       ///< this host asked the rig for no frames, or for none of this pulse
    out_of_step,     ///< the rig counts pulses differently from the rest of the stage
};

/// All rigs' views of the same instant: those that came within the latency budget.
struct FrameSet {
    struct Slot {
        std::string rig;
        std::shared_ptr<const RigFrame> frame;  ///< null: absent
        Absence absence = Absence::none;
    };
    std::uint64_t trigger_index = 0;
    std::vector<Slot> slots;   ///< one for every rig of the stage, in the stage's order
    MonotonicTime complete{};  ///< when the set was closed

    int present() const {
        int n = 0;
        for (const Slot& slot : slots) n += slot.frame != nullptr;
        return n;
    }
};

}  // namespace vantage
