#pragma once

#include <nlohmann/json.hpp>

#include "common/base/cli/stop_signal.h"
#include "common/config/stage_config.h"
#include "common/receive/stage_receiver.h"

namespace vantage {

enum class LookUntil {
    all_answered,   ///< a refusal is an answer
    all_connected,  ///< a rig that refuses may be started anew meanwhile
    all_send        ///< or say why they do not: a rig that has just started sends in a moment
};

/// What the rigs of a stage say of themselves: looks until they do, or the time is up. Frames are
/// not asked for.
ReceiverStatus look_at(const StageConfig& stage, double wait_s, LookUntil until, StopSignal& stop);

/// One of these rigs, for machines.
nlohmann::ordered_json to_json(const RigStatus& rig, const std::vector<RigStatus>& rigs);

}  // namespace vantage
