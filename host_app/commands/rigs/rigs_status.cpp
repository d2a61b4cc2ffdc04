#include <algorithm>
#include <chrono>

#include "common/base/time/time.h"
#include "common/wire/status_report.h"
#include "host_app/commands/rigs/rigs_commands.h"
#include "host_app/session/report/live_report.h"

namespace vantage {

ReceiverStatus gather_status(const StageConfig& stage, double wait_s, StatusCondition condition,
                             StopSignal& stop) {
    StageReceiver receiver(stage, StageReceiver::Purpose::report);
    const auto has_answered = [&](const RigStatus& rig) {
        if (condition == StatusCondition::all_send && rig.connected)
            return rig.health.published_hz > 0 || waits_for_a_host(rig) || !trouble_of(rig).empty();
        return rig.connected ||
               (condition != StatusCondition::all_connected && !rig.refused.empty());
    };
    const MonotonicTime end = MonotonicClock::now() + from_s(wait_s);
    while (MonotonicClock::now() < end && !stop.wait_for(StopSignal::look_period)) {
        const ReceiverStatus status = receiver.status();
        if (std::all_of(status.rigs.begin(), status.rigs.end(), has_answered)) break;
    }
    return receiver.status();
}

nlohmann::ordered_json to_json(const RigStatus& rig, const std::vector<RigStatus>& rigs) {
    nlohmann::ordered_json json{{"name", rig.rig},
                                {"endpoint", rig.endpoint},
                                {"connected", rig.connected},
                                {"state", state_of(rig)}};
    if (const std::string trouble = trouble_of(rig); !trouble.empty()) json["trouble"] = trouble;
    if (const std::string silence = silence_of(rig); !silence.empty()) json["silence"] = silence;
    json["delivers"] = delivers(rig, rigs);
    json["clock"] = clock_text(rig);
    json["same_clock"] = rig.same_clock;
    json["sync"] = to_json(rig.sync);
    json["health"] = to_json(rig.health);
    json["frames"] = to_json(rig.since_start);
    return json;
}

}  // namespace vantage
