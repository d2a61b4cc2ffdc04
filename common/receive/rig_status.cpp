#include "common/receive/rig_status.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/base/counted.h"
#include "common/base/time/pulse_grid.h"

namespace vantage {
namespace {

std::string trouble_of_link(const RigStatus& rig) {
    if (rig.is_removed) return removed_rig;
    if (!rig.refused.empty()) return rig.refused;
    if (rig.connected) return {};
    return rig.unreachable.empty() ? fmt::format("{} is silent", rig.endpoint) : rig.unreachable;
}

std::string trouble_of_pulses(const RigStatus& rig) {
    if (rig.is_out_of_step)
        return "it counts pulses differently from the rest of the stage: check its clock";
    if (rig.lags)
        return "its frames arrive after the latency budget, so the host does not wait for them: "
               "check its clock and its network";
    if (rig.names_no_pulse || (rig.unsynchronized > 0 && rig.in_frame_sets == 0))
        return "its frames have no trigger pulse of the stage: configure a trigger, or check its "
               "wire";
    return {};
}

}  // namespace

std::string clock_text(const RigStatus& rig) {
    const RigSync& sync = rig.sync;
    std::string text;
    if (rig.same_clock)
        text = "this computer's clock";
    else if (sync.disciplined)
        text = fmt::format("PTP {}, offset {:.0f} ns, path delay {:.0f} ns", sync.ptp_state,
                           sync.ptp_offset_ns, sync.ptp_path_delay_ns);
    else if (sync.ptp_state.empty())
        text = fmt::format("{} (no ptp4l at the rig)", clocks_not_disciplined);
    else if (sync.ptp_state == "SLAVE")
        text = fmt::format("{} (ptp4l is SLAVE, but nothing sets the system clock: start phc2sys)",
                           clocks_not_disciplined);
    else
        text = fmt::format("{} (ptp4l is {})", clocks_not_disciplined, sync.ptp_state);
    if (const std::string worry = tai_warning(rig); !worry.empty()) text += "; " + worry;
    if (const std::string step = clock_step_text(sync); !step.empty()) text += "; " + step;
    return text;
}

std::string clock_step_text(const RigSync& sync) {
    if (sync.clock_steps == 0) return {};
    return fmt::format("its clock was set {}, last by {:+.1f} ms", counted_times(sync.clock_steps),
                       sync.clock_step_ms);
}

std::string tai_warning(const RigStatus& rig) {
    if (rig.sync.tai_offset_s == rig.own_tai_offset_s) return {};
    return fmt::format(
        "its TAI offset from UTC is {} s and this computer's is {} s: set it at the end that has 0 "
        "(ptp4l with phc2sys, or chrony with leapsectz), or at neither",
        rig.sync.tai_offset_s, rig.own_tai_offset_s);
}

std::string rate_warning(const RigStatus& rig) {
    if (rig.sync.rate_hz == 0 || rig.stage_rate_hz == 0) return {};
    // PulseGrid makes 29.97 and 30000/1001 equal.
    const double of_rig = PulseGrid(rig.sync.rate_hz).rate_hz();
    const double of_stage = PulseGrid(rig.stage_rate_hz).rate_hz();
    constexpr double same = 1e-6;
    if (std::abs(of_rig / of_stage - 1) < same) return {};
    return fmt::format("it runs at {:g} Hz and the stage at {:g} Hz: give both the same rate_hz",
                       rig.sync.rate_hz, rig.stage_rate_hz);
}

std::string trouble_of(const RigStatus& rig) {
    for (std::string trouble : {trouble_of_link(rig), rate_warning(rig)})
        if (!trouble.empty()) return trouble;
    return trouble_of_pulses(rig);
}

bool gives_pictures(const RigStatus& rig, const std::vector<RigStatus>& rigs) {
    if (!trouble_of_link(rig).empty() || !trouble_of_pulses(rig).empty()) return false;
    return rate_warning(rig).empty() ||
           std::none_of(rigs.begin(), rigs.end(), [](const RigStatus& other) {
               return trouble_of(other).empty() && other.health.published_hz > 0;
           });
}

}  // namespace vantage
