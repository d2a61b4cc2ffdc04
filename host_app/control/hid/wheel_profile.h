#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/files/embedded_text.h"
#include "host_app/control/hid/jog_family.h"
#include "host_app/control/table/control_command.h"

namespace vantage {

/// Built-in copies of the files in hw_config/jog.
std::span<const EmbeddedText> embedded_wheels();

class TomlTable;

inline constexpr std::size_t max_wheel_file_bytes = 1 << 20;
/// Action of a control without a function.
inline constexpr const char* does_nothing = "nothing";

/// Target of a control that is turned or pushed.
enum class AxisAction {
    nothing,
    shuttle,  ///< speed of the wheel's target, spring-centred
    command,  ///< a command with steps
};

struct AxisMap {
    AxisAction action = AxisAction::nothing;
    const ControlCommand* command = nullptr;  ///< for AxisAction::command
    double dead_zone = 0;    ///< for an axis: it counts as at rest within this distance; 0..0.9
    double sensitivity = 1;  ///< factor
    /// For an axis: exponent of its response beyond the dead zone; above 1 it is finer near the
    /// rest position. 0.2..5
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
    CommandCall call = {};  ///< for ButtonAction::command; a shot stores after `store_next`
};

/// Reads the action and response of an axis from its table. Throws Error like the table.
AxisMap read_axis_map(TomlTable& table);
/// Parses the action of a button from the key `control`. Throws Error if it is not a command.
ButtonMap read_button_map(const TomlTable& table, const std::string& control,
                          const std::string& action);

/// Position and type of one control in a jog wheel's reports.
struct ReportField {
    enum class Kind {
        delta,    ///< steps since the previous report
        counter,  ///< counts steps and wraps; the first report only sets the start
        axis,     ///< position of a spring-centred control, `full_scale` at its end
        buttons,  ///< a bit mask; bit n is the button NAME with the number n + 1
    };
    Kind kind = Kind::delta;
    std::string name;
    std::optional<std::uint8_t> report_id;  ///< empty if the device's reports have no id
    int byte = 0;                           ///< counted with the id, which is byte 0
    int bit = 0;                            ///< lowest bit within that byte, 0..7
    int bits = 8;                           ///< little-endian; 1..32
    bool is_signed = true;                  ///< for delta and axis
    double centre = 0;                      ///< for an axis: its value at rest
    double full_scale = 127;                ///< for an axis: distance from there to its end
};

/// Profile of a wheel: the action of each control and, for a wheel without a family, the layout of
/// its reports. Each profile is one file (hw_config/jog/ documents every key).
struct WheelProfile {
    std::string name;
    std::vector<JogId> devices;
    std::map<std::string, AxisMap> axes;
    std::map<std::string, ButtonMap> buttons;
    std::vector<ReportField> report;  ///< empty: a family decodes the device
    std::filesystem::path file;       ///< file it was read from, or the name of the built-in one
    bool is_built_in = false;
    std::string text;  ///< content of the file
};

/// Parses a profile. Throws Error with file and line for a control that the device does not have,
/// an unknown action, or a device without a family and without [[report]].
WheelProfile read_wheel_profile(std::string_view text, const std::filesystem::path& name);

/// Loads the profiles that come with Vantage, then those of the folder or file `own`; the last
/// profile for a device counts. An empty path adds none. Throws Error.
std::vector<WheelProfile> load_wheel_profiles(const std::filesystem::path& own = {});

/// Loads the same, and in between the profiles of this user's own folder, where the desk saves
/// them.
std::vector<WheelProfile> load_all_wheel_profiles(const std::filesystem::path& own);
/// Path of that folder, which need not exist.
std::filesystem::path user_wheel_folder();

/// All controls of a wheel's devices, each once. Precondition: the profile was read from a file.
std::vector<JogControl> controls_of(const WheelProfile& profile);

/// Scales a position so that it is 0 at the edge of the dead zone and 1 at the end.
double without_dead_zone(double position, double dead_zone);

/// Response of an axis to a position of -1..1, before its factor: 0 in its dead zone, then along
/// its curve.
double response_of(const AxisMap& map, double position);

/// The last profile for a device; null if there is none.
const WheelProfile* find_profile(const std::vector<WheelProfile>& profiles, JogId id);

/// Creates a decoder from the report description of a wheel's profile. It refuses reports with
/// another id, or too short for their fields.
std::unique_ptr<JogDecoder> make_described_decoder(std::vector<ReportField> fields);

}  // namespace vantage
