#include "host_app/desk/air_verdict.h"

#include <cmath>

#include <fmt/format.h>

namespace vantage {
namespace {

using Level = AirVerdict::Level;

/// Time that a rig may be absent before it counts: a single missed pulse is not visible.
constexpr double max_absent_s = 1;
/// Age of a live picture from which it looks late, and from which it no longer shows the present.
constexpr double late_s = 1, old_s = 3;
/// Share of repeated ticks from which motion stutters visibly.
constexpr double max_repeated_share = 0.25;

/// Returns why there is no current picture of the stage; empty if there is one.
std::string why_not(const DeskState& state) {
    if (state.waiting)
        return state.has_frame_sets ? "the renderer compiles its shaders"
                                    : "no rig has sent a frame yet";
    if (state.is_of_take()) return "";
    if (state.signal == SignalState::no_signal) return "no rig sends frames";
    if (state.signal == SignalState::stale) return "the newest frame is old";
    if (state.age_s && *state.age_s >= old_s)
        return fmt::format("the picture is {:.0f} s old", *state.age_s);
    return "";
}

/// Returns the most serious visible fault; empty if there is none.
std::string why_caution(const DeskState& state) {
    if (state.coverage && Corridor::place_of(state.coverage->share) != CorridorPlace::inside)
        return fmt::format("the rigs cover {:.0f} % of the picture", 100 * state.coverage->share);
    for (const DeskRig& rig : state.rigs)
        if (rig.state != RigState::present && rig.absent_s >= max_absent_s)
            return fmt::format("{}: {}", rig.name,
                               state.is_of_take() ? "not in the take" : label_of(rig.state).words);
    for (const DeskOutput& output : state.outputs)
        if (output.is_failed) return fmt::format("{} has failed", output.name);
    if (state.take && !state.take->failure.empty()) return "the take has failed";
    if (state.take && !state.take->trouble.empty()) return state.take->trouble;
    if (state.age_s && *state.age_s >= late_s)
        return fmt::format("the picture is {:.1f} s old", *state.age_s);
    if (state.repeat_rate_hz > max_repeated_share * state.tick_rate_hz)
        return fmt::format("{:.0f} of {:g} fps are repeated frames", state.repeat_rate_hz,
                           std::round(state.tick_rate_hz));
    for (const DeskRig& rig : state.rigs)
        if (!rig.worries.empty()) return fmt::format("{}: {}", rig.name, rig.worries.front());
    return state.computer_worry;
}

}  // namespace

AirVerdict air_verdict(const DeskState& state) {
    if (std::string why = why_not(state); !why.empty()) return {Level::not_ready, std::move(why)};
    if (state.coverage && Corridor::place_of(state.coverage->share) == CorridorPlace::beyond)
        return {Level::not_ready, "the camera is beyond what the rigs cover"};
    if (std::string why = why_caution(state); !why.empty()) return {Level::caution, std::move(why)};
    return {};
}

RigStateLabel label_of(RigState state) {
    switch (state) {
        case RigState::present:
            return {"live", Mark::good};
        case RigState::starting:
            return {"no frame yet", Mark::care};
        case RigState::late:
            return {"late", Mark::care};
        case RigState::missed:
            return {"missed", Mark::care};
        case RigState::refused:
            return {"refused", Mark::bad};
        case RigState::disconnected:
            break;
    }
    return {"no link", Mark::bad};
}

}  // namespace vantage
