#include "host_app/desk/air_verdict.h"

#include <cmath>

#include <fmt/format.h>

#include "host_app/desk/rig_verdict.h"

namespace vantage {
namespace {

using Level = AirVerdict::Level;

/// A pulse that a rig has missed is seen by nobody, and one look should not come at a bad moment.
constexpr double missed_s = 1;
/// Of a live picture: where people begin to see that it is late, and where it is not of now.
constexpr double late_s = 1, old_s = 3;
/// Of the ticks that repeat a picture: more is seen as a stutter.
constexpr double most_repeated = 0.25;

/// Why nothing of the stage can be shown.
std::string why_not(const DeskState& state) {
    if (state.waiting)
        return state.has_frame_sets ? "the renderer compiles its shaders"
                                    : "no rig has sent a picture yet";
    if (state.is_of_take()) return "";
    if (state.signal == SignalState::no_signal) return "no rig gives pictures";
    if (state.signal == SignalState::stale) return "the newest picture is old";
    if (state.age_s && *state.age_s >= old_s)
        return fmt::format("the picture is {:.0f} s old", *state.age_s);
    return "";
}

std::string why_with_care(const DeskState& state) {
    if (state.coverage && Corridor::place_of(state.coverage->share) != CorridorPlace::inside)
        return fmt::format("the rigs cover {:.0f} % of the picture", 100 * state.coverage->share);
    for (const DeskRig& rig : state.rigs)
        if (rig.state != RigState::present && rig.absent_s >= missed_s)
            return fmt::format("{}: {}", rig.name,
                               state.is_of_take() ? "not in the take" : look_of(rig.state).words);
    for (const DeskOutput& output : state.outputs)
        if (output.is_failed) return fmt::format("{} has failed", output.name);
    if (state.take && !state.take->failure.empty()) return "the take has failed";
    if (state.age_s && *state.age_s >= late_s)
        return fmt::format("the picture is {:.1f} s old", *state.age_s);
    if (state.repeat_rate_hz > most_repeated * state.tick_rate_hz)
        return fmt::format("{:.0f} of {:g} pictures a second are repeated", state.repeat_rate_hz,
                           std::round(state.tick_rate_hz));
    for (const DeskRig& rig : state.rigs)
        if (!rig.worries.empty()) return fmt::format("{}: {}", rig.name, rig.worries.front());
    return "";
}

}  // namespace

AirVerdict air_verdict(const DeskState& state) {
    if (std::string why = why_not(state); !why.empty()) return {Level::not_ready, std::move(why)};
    if (state.coverage && Corridor::place_of(state.coverage->share) == CorridorPlace::beyond)
        return {Level::not_ready, "the camera is beyond what the rigs cover"};
    if (std::string why = why_with_care(state); !why.empty())
        return {Level::with_care, std::move(why)};
    return {};
}

}  // namespace vantage
