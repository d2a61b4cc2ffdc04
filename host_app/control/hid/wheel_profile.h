#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "host_app/control/hid/described_decoder.h"
#include "host_app/control/hid/jog_family.h"

namespace vantage {

/// What a turned or pushed control moves.
enum class AxisAction {
    nothing,
    wheel,      ///< steps: along the move, around the orbit or through the past, as the mode says
    shuttle,    ///< speed of the same, spring-centred
    orbit,      ///< around the pivot, positive to the camera's right
    elevate,    ///< positive up
    pan_right,  ///< shifts camera and pivot
    pan_up,
    dolly,  ///< positive nearer
    zoom,   ///< positive narrower
};

struct AxisMap {
    AxisAction action = AxisAction::nothing;
    double dead_zone = 0;    ///< of an axis: nearer to its rest than this it is at rest; 0..0.9
    double sensitivity = 1;  ///< factor
    bool inverted = false;
};

enum class ButtonAction {
    nothing,
    shot,   ///< flies to shot `number`; after `store` it keeps the view as that shot
    store,  ///< the next shot button stores
    freeze,
    mode,         ///< next of what wheel and shuttle drive
    play,         ///< plays or leaves the planned move
    reset,        ///< back to the start
    synthesiser,  ///< the next one
    live,         ///< out of the past, or of a frozen instant
    mark_in,
    mark_out,
    no_marks,
    loop,  ///< plays between the marks again and again, or no more
    cue,   ///< to the in mark
    slower,
    faster,  ///< to the next speed of the past
};

struct ButtonMap {
    ButtonAction action = ButtonAction::nothing;
    int number = 0;  ///< of a shot, 1..9
};

/// What a wheel's controls do, and for a wheel that no family knows how its reports are read. A
/// file each (hw_config/jog/ documents every key).
struct WheelProfile {
    std::string name;
    std::vector<JogId> devices;
    std::map<std::string, AxisMap> axes;
    std::map<std::string, ButtonMap> buttons;
    std::vector<ReportField> report;  ///< empty: a family reads the device
};

/// Throws Error with file and line for whatever does not fit: a control that the device does not
/// have, an action that does not exist, a device that no family reads and that has no [[report]].
WheelProfile read_wheel_profile(std::string_view text, const std::filesystem::path& name);

/// The profiles that come with Vantage, and those of the folder or the one file `own` on top: of
/// two for one device the last one counts. An empty path: none. Throws Error.
std::vector<WheelProfile> load_wheel_profiles(const std::filesystem::path& own = {});

/// The last profile for a device; null if there is none.
const WheelProfile* find_profile(const std::vector<WheelProfile>& profiles, JogId id);

}  // namespace vantage
