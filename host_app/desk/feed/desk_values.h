#pragma once

#include <optional>
#include <vector>

#include "host_app/control/hid/wheel_input.h"
#include "host_app/desk/desk_state.h"
#include "host_app/desk/feed/desk_pictures.h"
#include "host_app/programme/programme.h"
#include "host_app/session/report/live_report.h"

namespace vantage {

/// Formats the running summary for the side panel: ticks, durations, instants and levels of
/// quality. Measurements without samples are left out.
std::vector<DeskFigure> desk_figures(const LiveReport& report);

/// The state of a rig in the present frame set; null: there is none yet.
RigState state_in(const FrameSet* set, const RigStatus& status);

/// The age of the picture; nothing while the picture is held or from the past.
std::optional<double> live_age_s(const ProgrammeState& programme);

/// Converts clips and play list to the desk's values. `tai_offset_s` is as in TimecodeClock.
DeskReplay desk_replay(const ProgrammeState& programme, const ClipPictures& pictures,
                       int tai_offset_s);

/// Converts an open wheel map to the desk's values; nothing if the map is closed.
std::optional<DeskWheel> desk_wheel(const std::optional<WheelMapView>& view);

}  // namespace vantage
