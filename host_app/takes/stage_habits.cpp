#include "host_app/takes/stage_habits.h"

#include <algorithm>
#include <numbers>

#include "common/base/error.h"
#include "common/base/log.h"

namespace vantage {

FlightHabits habits_of(const StageConfig::Flight& flight) {
    constexpr double rad = std::numbers::pi / 180;
    FlightHabits habits;
    habits.holds_horizon = flight.holds_horizon;
    habits.shot_s = flight.shot_s;
    habits.keyframe_gap_s = flight.keyframe_s;
    habits.max_turn_rad_s = rad * flight.max_turn_deg_s;
    habits.max_zoom_rad_s = rad * flight.max_zoom_deg_s;
    habits.max_speed_m_s = flight.max_speed_m_s;
    habits.ramp_s = flight.ramp_s;
    habits.follow_s = flight.smoothing_s;
    return habits;
}

FlightHabits habits_of(const TakeReader& take) {
    const std::vector<TakeAttachment>& attachments = take.facts().attachments;
    const auto stage = std::find_if(
        attachments.begin(), attachments.end(),
        [](const TakeAttachment& attachment) { return attachment.name == stage_attachment; });
    if (stage == attachments.end()) return {};
    try {
        return habits_of(stage_flight_from(
            {reinterpret_cast<const char*>(stage->bytes.data()), stage->bytes.size()},
            take.path() / stage_attachment));
    } catch (const Error& error) {
        log_warning("using the default flight settings instead of the take's: {}", error.what());
        return {};
    }
}

}  // namespace vantage
