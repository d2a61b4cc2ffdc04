#pragma once

#include <nlohmann/json.hpp>

#include "common/base/cli/stop_signal.h"
#include "common/config/stage_config.h"
#include "common/receive/stage_receiver.h"

namespace CLI {
class App;
}

namespace vantage {

/// `vantage rigs plan`: checks whether the network carries what the rigs send.
void add_rigs_plan(CLI::App& rigs);
/// `vantage rigs update`: lists the rigs' versions and the commands that update them.
void add_rigs_update(CLI::App& rigs);
/// `vantage rigs bugreport`: collects a support archive.
void add_rigs_bugreport(CLI::App& rigs);

/// When gather_status() is satisfied.
enum class StatusCondition {
    all_answered,   ///< every rig is connected or has refused this host
    all_connected,  ///< a rig that refuses may restart and connect later
    all_send        ///< every rig sends frames, or reports why not
};

/// Connects to the rigs of a stage without requesting frames, and returns their status once the
/// condition holds or `wait_s` seconds have passed.
ReceiverStatus gather_status(const StageConfig& stage, double wait_s, StatusCondition condition,
                             StopSignal& stop);

/// Formats one of these rigs for JSON.
nlohmann::ordered_json to_json(const RigStatus& rig, const std::vector<RigStatus>& rigs);

}  // namespace vantage
