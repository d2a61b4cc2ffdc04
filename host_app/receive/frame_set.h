#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/base/time.h"
#include "common/wire/frame_message.h"

namespace vantage {

/// Why a rig is not in a set.
enum class Absence { none, late, missed_by_rig, disconnected };

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
