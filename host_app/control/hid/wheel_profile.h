#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "host_app/control/hid/described_decoder.h"
#include "host_app/control/hid/jog_family.h"
#include "host_app/control/table/control_command.h"

namespace vantage {

class TomlTable;

inline constexpr std::size_t max_wheel_file_bytes = 1 << 20;
/// What a control is called that does nothing.
inline constexpr const char* does_nothing = "nothing";

/// What a turned or pushed control moves.
enum class AxisAction {
    nothing,
    shuttle,  ///< speed of what the wheel drives, spring-centred
    command,  ///< one of those with steps
};

struct AxisMap {
    AxisAction action = AxisAction::nothing;
    const ControlCommand* command = nullptr;  ///< of AxisAction::command
    double dead_zone = 0;    ///< of an axis: nearer to its rest than this it is at rest; 0..0.9
    double sensitivity = 1;  ///< factor
    /// Of an axis: the power of its way beyond the dead zone; above 1 finer near its rest. 0.2..5
    double curve = 1;
    bool inverted = false;
};

enum class ButtonAction {
    nothing,
    store_next,  ///< the next shot button stores
    command,
};

struct ButtonMap {
    ButtonAction action = ButtonAction::nothing;
    CommandCall call = {};  ///< of ButtonAction::command; a shot stores after `store_next`
};

/// The action of an axis with all that shapes it, out of its table. Throws Error as the table does.
AxisMap read_axis_map(TomlTable& table);
/// What a button does, by the words of its key `control`. Throws Error for what is no command.
ButtonMap read_button_map(const TomlTable& table, const std::string& control,
                          const std::string& action);

/// What a wheel's controls do, and for a wheel that no family knows how its reports are read. A
/// file each (hw_config/jog/ documents every key).
struct WheelProfile {
    std::string name;
    std::vector<JogId> devices;
    std::map<std::string, AxisMap> axes;
    std::map<std::string, ButtonMap> buttons;
    std::vector<ReportField> report;  ///< empty: a family reads the device
    std::filesystem::path file;       ///< that it was read from, or the built-in one's name
    bool is_built_in = false;
    std::string text;  ///< of the file
};

/// Throws Error with file and line for whatever does not fit: a control that the device does not
/// have, an action that does not exist, a device that no family reads and that has no [[report]].
WheelProfile read_wheel_profile(std::string_view text, const std::filesystem::path& name);

/// The profiles that come with Vantage, and those of the folder or the one file `own` on top: of
/// two for one device the last one counts. An empty path: none. Throws Error.
std::vector<WheelProfile> load_wheel_profiles(const std::filesystem::path& own = {});

/// Likewise, with those of this user's own folder, where the desk saves them, in between.
std::vector<WheelProfile> load_all_wheel_profiles(const std::filesystem::path& own);
/// That folder, be it there or not.
std::filesystem::path user_wheel_folder();

/// All controls of a wheel's devices, each once. Precondition: it was read.
std::vector<JogControl> controls_of(const WheelProfile& profile);

/// The position outside the dead zone, stretched so that it starts at 0 and ends at 1.
double without_dead_zone(double position, double dead_zone);

/// What an axis asks for at a position of -1..1, before its factor: nothing in its dead zone, and
/// from there along its curve to its end.
double response_of(const AxisMap& map, double position);

/// The last profile for a device; null if there is none.
const WheelProfile* find_profile(const std::vector<WheelProfile>& profiles, JogId id);

}  // namespace vantage
