#include "host_app/control/hid/wheel_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "common/base/cli/nearest_name.h"
#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/files/folder.h"
#include "common/config/toml_reader.h"
#include "host_app/control/hid/jog_family.h"

namespace vantage {
namespace {

constexpr int wheel_file_version = 1;
/// Longest report on USB.
constexpr int max_report_byte = 63;

template <class Action>
struct Named {
    const char* name;
    Action action;
};
constexpr const char *shuttle = "shuttle", *store_next = "store";
constexpr Named<ReportField::Kind> field_kinds[] = {{"delta", ReportField::Kind::delta},
                                                    {"counter", ReportField::Kind::counter},
                                                    {"axis", ReportField::Kind::axis},
                                                    {"buttons", ReportField::Kind::buttons}};

template <class Action, std::size_t count>
std::vector<std::string> names_of(const Named<Action> (&all)[count]) {
    std::vector<std::string> names;
    for (const Named<Action>& named : all) names.emplace_back(named.name);
    return names;
}

template <class Action, std::size_t count>
const Action* find_named(const Named<Action> (&all)[count], const std::string& name) {
    for (const Named<Action>& named : all)
        if (name == named.name) return &named.action;
    return nullptr;
}

template <class Action, std::size_t count>
Action read_named(TomlTable& table, std::string_view key, const Named<Action> (&all)[count]) {
    std::string name;
    table.require(key);
    table.read(key, name);
    const Action* found = find_named(all, name);
    if (!found && table.has(key))
        table.refuse(key,
                     fmt::format("must not be '{}'; {}", name, suggest_name(name, names_of(all))));
    return found ? *found : Action{};
}

/// An axis controls a command with steps, or a shuttle.
void read_axis_action(TomlTable& table, AxisMap& map) {
    constexpr std::string_view key = "action";
    std::string name;
    table.require(key);
    table.read(key, name);
    if (!table.has(key) || name == does_nothing) return;
    if (name == shuttle) {
        map.action = AxisAction::shuttle;
        return;
    }
    std::vector<std::string> names{does_nothing, shuttle};
    for (const ControlCommand& command : control_commands()) {
        if (command.argument != CommandArgument::steps) continue;
        if (name == command.name) {
            map.action = AxisAction::command;
            map.command = &command;
            return;
        }
        names.emplace_back(command.name);
    }
    table.refuse(key, fmt::format("must not be '{}'; {}", name, suggest_name(name, names)));
}

ReportField read_field(TomlTable& table) {
    ReportField field;
    table.require("name");
    table.read("name", field.name);
    field.kind = read_named(table, "kind", field_kinds);
    int report_id = -1;
    table.read("report_id", report_id, {1, 255});
    if (table.has("report_id")) field.report_id = static_cast<std::uint8_t>(report_id);
    table.require("byte");
    table.read("byte", field.byte, {0, max_report_byte});
    table.read("bit", field.bit, {0, 7});
    table.read("bits", field.bits, {1, 32});
    table.read("signed", field.is_signed);
    table.read("centre", field.centre, {-1e9, 1e9});
    table.read("full_scale", field.full_scale, {1, 1e9});
    if (table.has("name") && field.name.empty()) table.refuse("name", "must not be empty");
    if (field.report_id && field.byte == 0)
        table.refuse("byte", "is 0, where the report's id stands: the first byte behind it is 1");
    return field;
}

/// Controls of every device of a profile. Throws Error if no family or description can read one of
/// them.
std::vector<std::vector<JogControl>> controls_of(const WheelProfile& profile,
                                                 const TomlTable& top) {
    if (!profile.report.empty()) return {make_described_decoder(profile.report)->controls()};
    std::vector<std::vector<JogControl>> all;
    for (const JogId id : profile.devices) {
        const std::unique_ptr<JogDecoder> decoder = make_known_decoder(id);
        if (!decoder)
            top.refuse("devices",
                       fmt::format("has {}, which Vantage cannot read by itself: describe its "
                                   "reports with [[report]] tables",
                                   to_text(id)));
        all.push_back(decoder->controls());
    }
    return all;
}

bool has_control(const std::vector<std::vector<JogControl>>& devices, const std::string& name,
                 JogKind kind) {
    for (const std::vector<JogControl>& controls : devices)
        for (const JogControl& control : controls)
            if (control.kind == kind && control.name == name) return true;
    return false;
}

/// Throws Error if none of the devices has a control of this name and type.
void check_control(const TomlTable& table, std::string_view key, const std::string& name,
                   bool as_button, const std::vector<std::vector<JogControl>>& devices) {
    std::vector<std::string> known;
    for (const std::vector<JogControl>& controls : devices)
        for (const JogControl& control : controls) {
            if ((control.kind == JogKind::button) != as_button) continue;
            if (control.name == name) return;
            if (std::find(known.begin(), known.end(), control.name) == known.end())
                known.push_back(control.name);
        }
    table.refuse(key, fmt::format("is no {} of this device; {}", as_button ? "button" : "axis",
                                  suggest_name(name, known)));
}

WheelProfile read_members(TomlTable& top) {
    WheelProfile profile;
    top.require("name");
    top.read("name", profile.name);
    std::vector<std::string> devices;
    top.require("devices");
    top.read("devices", devices);
    for (const std::string& device : devices) {
        try {
            profile.devices.push_back(parse_jog_id(device));
        } catch (const Error& error) {
            top.refuse("devices", fmt::format("cannot be taken: {}", error.what()));
        }
    }
    if (top.has("devices") && devices.empty()) top.refuse("devices", "names no device");
    std::set<std::string> fields;
    top.read_tables("report", [&](TomlTable& table) {
        profile.report.push_back(read_field(table));
        if (!fields.insert(profile.report.back().name).second)
            table.refuse("name", fmt::format("is '{}' a second time", profile.report.back().name));
    });
    const auto controls = controls_of(profile, top);
    top.read_named_tables("axes", [&](const std::string& name, TomlTable& table) {
        check_control(table, "action", name, false, controls);
        const AxisMap map = read_axis_map(table);
        if (map.action == AxisAction::shuttle && !has_control(controls, name, JogKind::axis))
            table.refuse("action",
                         "must not be 'shuttle' for a control without a rest; 'wheel' "
                         "takes its steps");
        profile.axes[name] = map;
    });
    top.read_table("buttons", [&](TomlTable& table) {
        for (const std::string& name : table.keys()) {
            std::string action;
            table.read(name, action);
            check_control(table, name, name, true, controls);
            profile.buttons[name] = read_button_map(table, name, action);
        }
    });
    return profile;
}

/// Adds the profiles of a folder or a file; an empty path adds none.
void add_profiles_of(const std::filesystem::path& own, std::vector<WheelProfile>& profiles) {
    if (own.empty()) return;
    std::vector<std::filesystem::path> files{own};
    if (std::filesystem::is_directory(own)) {
        files.clear();
        for (const auto& entry : std::filesystem::directory_iterator(own))
            if (entry.path().extension() == ".toml") files.push_back(entry.path());
        std::sort(files.begin(), files.end());
        if (files.empty())
            fail(
                "there is no wheel in {}: a wheel is a .toml file such as those in hw_config/jog "
                "(installed: /usr/share/doc/vantage/examples/jog)",
                own.string());
    }
    for (const std::filesystem::path& file : files)
        profiles.push_back(read_wheel_profile(read_text_file(file, max_wheel_file_bytes), file));
}

}  // namespace

AxisMap read_axis_map(TomlTable& table) {
    AxisMap map;
    read_axis_action(table, map);
    table.read("dead_zone", map.dead_zone, {0, 0.9});
    table.read("sensitivity", map.sensitivity, {0.001, 1000});
    table.read("curve", map.curve, {0.2, 5});
    table.read("inverted", map.inverted);
    return map;
}

ButtonMap read_button_map(const TomlTable& table, const std::string& control,
                          const std::string& action) {
    if (action == does_nothing) return {};
    if (action == store_next) return {ButtonAction::store_next, {}};
    if (const std::optional<CommandCall> call = parse_button_command(action))
        return {ButtonAction::command, *call};
    std::vector<std::string> names = button_commands();
    names.insert(names.end(), {does_nothing, store_next});
    table.refuse(control, fmt::format("must not be '{}'; {}", action, suggest_name(action, names)));
}

WheelProfile read_wheel_profile(std::string_view text, const std::filesystem::path& name) {
    WheelProfile profile;
    read_toml_text(text, name, wheel_file_version,
                   [&](TomlTable& top) { profile = read_members(top); });
    profile.file = name;
    profile.text = text;
    return profile;
}

std::vector<WheelProfile> load_wheel_profiles(const std::filesystem::path& own) {
    std::vector<WheelProfile> profiles;
    for (const EmbeddedText& wheel : embedded_wheels()) {
        profiles.push_back(
            read_wheel_profile(wheel.text, fmt::format("hw_config/jog/{}", wheel.name)));
        profiles.back().is_built_in = true;
    }
    add_profiles_of(own, profiles);
    return profiles;
}

std::filesystem::path user_wheel_folder() { return user_folder() / "jog"; }

std::vector<WheelProfile> load_all_wheel_profiles(const std::filesystem::path& own) {
    std::vector<WheelProfile> profiles = load_wheel_profiles();
    // The folder exists only once the desk has saved a profile.
    if (std::error_code none; !std::filesystem::is_empty(user_wheel_folder(), none) && !none)
        add_profiles_of(user_wheel_folder(), profiles);
    add_profiles_of(own, profiles);
    return profiles;
}

std::vector<JogControl> controls_of(const WheelProfile& profile) {
    if (!profile.report.empty()) return make_described_decoder(profile.report)->controls();
    std::vector<JogControl> controls;
    for (const JogId id : profile.devices)
        for (const JogControl& control : make_known_decoder(id)->controls())
            if (std::none_of(controls.begin(), controls.end(), [&](const JogControl& other) {
                    return other.kind == control.kind && other.name == control.name;
                }))
                controls.push_back(control);
    return controls;
}

double response_of(const AxisMap& map, double position) {
    const double way = without_dead_zone(position, map.dead_zone);
    return std::copysign(std::pow(std::abs(way), map.curve), way);
}

double without_dead_zone(double position, double dead_zone) {
    const double way = std::abs(position) - dead_zone;
    return way <= 0 ? 0 : std::copysign(std::min(way / (1 - dead_zone), 1.0), position);
}

const WheelProfile* find_profile(const std::vector<WheelProfile>& profiles, JogId id) {
    const auto found =
        std::find_if(profiles.rbegin(), profiles.rend(), [&](const WheelProfile& profile) {
            return std::find(profile.devices.begin(), profile.devices.end(), id) !=
                   profile.devices.end();
        });
    return found == profiles.rend() ? nullptr : &*found;
}

namespace {

/// Sign-extends a two's complement number of `bits` bits.
std::int64_t with_sign(std::uint64_t value, int bits) {
    const std::uint64_t sign = std::uint64_t{1} << (bits - 1);
    return static_cast<std::int64_t>(value ^ sign) - static_cast<std::int64_t>(sign);
}

class DescribedDecoder final : public JogDecoder {
  public:
    explicit DescribedDecoder(std::vector<ReportField> fields) {
        for (ReportField& field : fields) readings_.push_back({std::move(field), {}, {}, {}});
    }

    std::vector<JogControl> controls() const override {
        std::vector<JogControl> all;
        for (const Reading& reading : readings_) {
            const ReportField& field = reading.field;
            if (field.kind == ReportField::Kind::buttons)
                for (int bit = 0; bit < field.bits; ++bit)
                    all.push_back({JogKind::button, button(field, bit)});
            else
                all.push_back(
                    {field.kind == ReportField::Kind::axis ? JogKind::axis : JogKind::step,
                     field.name});
        }
        return all;
    }

    bool decode(std::span<const std::uint8_t> report, std::vector<JogEvent>& events) override {
        bool is_known = false;
        for (const Reading& reading : readings_) {
            if (!is_in(reading.field, report)) continue;
            if (bytes_needed(reading.field) > report.size()) return false;
            is_known = true;
        }
        for (Reading& reading : readings_)
            if (is_in(reading.field, report)) decode_field(reading, report, events);
        return is_known;
    }

  private:
    struct Reading {
        ReportField field;
        std::optional<std::uint64_t> counter;
        AxisPosition axis;
        HeldButtons buttons;
    };

    static std::string button(const ReportField& field, int bit) {
        return fmt::format("{}{}", field.name, bit + 1);
    }
    static bool is_in(const ReportField& field, std::span<const std::uint8_t> report) {
        return !field.report_id || (!report.empty() && report[0] == *field.report_id);
    }
    static std::size_t bytes_needed(const ReportField& field) {
        return static_cast<std::size_t>(field.byte + (field.bit + field.bits + 7) / 8);
    }

    static void decode_field(Reading& reading, std::span<const std::uint8_t> report,
                             std::vector<JogEvent>& events) {
        const ReportField& field = reading.field;
        const auto first = static_cast<std::size_t>(field.byte);
        const std::uint64_t value =
            uint_at(report, first, bytes_needed(field) - first) >> field.bit &
            ((std::uint64_t{1} << field.bits) - 1);
        switch (field.kind) {
            case ReportField::Kind::delta: {
                const auto turned =
                    static_cast<double>(field.is_signed ? with_sign(value, field.bits)
                                                        : static_cast<std::int64_t>(value));
                if (turned != 0) events.push_back({JogKind::step, field.name, turned});
                break;
            }
            case ReportField::Kind::counter: {
                const std::uint64_t mask = (std::uint64_t{1} << field.bits) - 1;
                const std::uint64_t before = reading.counter.value_or(value);
                const std::int64_t turned = with_sign((value - before) & mask, field.bits);
                if (turned != 0)
                    events.push_back({JogKind::step, field.name, static_cast<double>(turned)});
                reading.counter = value;
                break;
            }
            case ReportField::Kind::axis: {
                const auto at =
                    static_cast<double>(field.is_signed ? with_sign(value, field.bits)
                                                        : static_cast<std::int64_t>(value));
                reading.axis.update(std::clamp((at - field.centre) / field.full_scale, -1.0, 1.0),
                                    field.name, events);
                break;
            }
            case ReportField::Kind::buttons:
                reading.buttons.update(
                    value, [&](int bit) { return button(field, bit); }, events);
                break;
        }
    }

    std::vector<Reading> readings_;
};

}  // namespace

std::unique_ptr<JogDecoder> make_described_decoder(std::vector<ReportField> fields) {
    return std::make_unique<DescribedDecoder>(std::move(fields));
}

}  // namespace vantage
