#include "host_app/control/ports/messages/midi_map.h"

#include <charconv>

#include <fmt/format.h>

#include "common/base/cli/nearest_name.h"
#include "common/base/files/atomic_file.h"
#include "common/config/toml_reader.h"

namespace vantage {
namespace {

/// Removes a number from the start of the text, "36" from "36 ch 2". Empty if there is no number
/// within the limits.
std::optional<int> take_midi_number(std::string_view& text, int least, int most) {
    int number = 0;
    const char* last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, number);
    if (error != std::errc() || number < least || number > most) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return number;
}

bool take_midi_word(std::string_view& text, std::string_view word) {
    if (!text.starts_with(word)) return false;
    text.remove_prefix(word.size());
    return true;
}

constexpr int midi_map_version = 1;
constexpr std::size_t most_midi_map_bytes = 1 << 20;
/// Last controller with 14 bits: the low seven bits of controllers 0 to 31 are in 32 to 63.
constexpr int most_fine_controller = 31;

MidiControl read_midi_control(const TomlTable& table, const std::string& name) {
    const std::optional<MidiControl> control = parse_midi_control(name);
    if (!control)
        table.refuse(name,
                     "is no control: \"note 36\", \"cc 7\" (0 to 127) or \"bend\", with \" ch 3\" "
                     "behind it for one channel of 16");
    return *control;
}

/// Adds a control. Throws Error if it is already there in another spelling.
template <class Value>
void keep_midi(std::map<MidiControl, Value>& all, const MidiControl& control, Value value,
               const TomlTable& table, const std::string& name) {
    if (!all.emplace(control, std::move(value)).second)
        table.refuse(name, fmt::format("is {} a second time", to_text(control)));
}

MidiAxisMap read_midi_axis(const MidiControl& control, const std::string& name, TomlTable& table) {
    MidiAxisMap axis;
    std::string kind = control.kind == MidiKind::bend ? "stick" : "fader";
    std::string encoding = "twos";
    int bits = 7;
    table.read_choice("kind", kind, {"fader", "stick", "encoder"});
    table.read_choice("encoding", encoding, {"twos", "offset", "sign", "127/0"});
    table.read("bits", bits, {7, 14});
    table.read("travel_steps", axis.travel_steps, {1, 100000});
    if (control.kind == MidiKind::note)
        table.refuse("action", "cannot be a note's: it is no axis; put it under [buttons]");
    if (bits != 7 && bits != 14) table.refuse("bits", "must be 7 or 14");
    if (bits == 14 && (control.kind == MidiKind::bend || control.number > most_fine_controller))
        table.refuse("bits", fmt::format("are 14 for the controllers 0 to {} alone, and {} {}",
                                         most_fine_controller, name,
                                         control.kind == MidiKind::bend ? "has them anyway"
                                                                        : "has no lower half"));
    const bool is_encoder = kind == "encoder";
    if (is_encoder && (bits == 14 || control.kind == MidiKind::bend))
        table.refuse("kind", "must not be 'encoder' for what has 14 bits");
    if (table.has("encoding") && !is_encoder)
        table.refuse("encoding", "is an encoder's: say kind = \"encoder\"");
    if (table.has("travel_steps") && kind != "fader")
        table.refuse("travel_steps", "is a fader's: say kind = \"fader\"");
    axis.is_fine = bits == 14;
    axis.travel = kind == "stick"        ? MidiTravel::stick
                  : !is_encoder          ? MidiTravel::fader
                  : encoding == "offset" ? MidiTravel::binary_offset
                  : encoding == "sign"   ? MidiTravel::sign_bit
                  : encoding == "127/0"  ? MidiTravel::ends
                                         : MidiTravel::twos;
    axis.map = read_axis_map(table);
    if (axis.map.action == AxisAction::shuttle && axis.travel != MidiTravel::stick)
        table.refuse("action",
                     "must not be 'shuttle' for a control without a rest; 'wheel' takes its steps");
    return axis;
}

MidiLampMap read_midi_lamp(const MidiControl& control, TomlTable& table) {
    MidiLampMap lamp{.control = control};
    if (control.kind == MidiKind::bend)
        table.refuse("lamp", "cannot be shown by a bend: take a note or a cc");
    std::string name;
    table.require("lamp");
    table.read("lamp", name);
    table.read("on", lamp.on, {0, most_midi_value});
    table.read("off", lamp.off, {0, most_midi_value});
    if (!table.has("lamp")) return lamp;
    std::vector<std::string> switches;
    for (const Lamp& each : lamps()) {
        if (!std::holds_alternative<bool>(each.of(ShowLamps{}))) continue;
        if (name == each.name) lamp.lamp = &each;
        if (!name.empty() && name == each.old_name) {
            warn_of_old_name(name, each.name);
            lamp.lamp = &each;
        }
        switches.emplace_back(each.name);
    }
    if (!lamp.lamp)
        table.refuse("lamp", fmt::format("must not be '{}': it is no lamp that is on or off; {}",
                                         name, suggest_name(name, switches)));
    return lamp;
}

template <class Value>
const Value* find_midi(const std::map<MidiControl, Value>& all, const MidiMessage& message) {
    const int number = message.kind == MidiKind::bend ? 0 : message.number;
    for (const int channel : {message.channel, 0})
        if (const auto found = all.find({message.kind, number, channel}); found != all.end())
            return &found->second;
    return nullptr;
}

}  // namespace

std::string fault_of(const MidiMessage& message) {
    const bool is_bend = message.kind == MidiKind::bend;
    if (message.channel < 1 || message.channel > midi_channels)
        return fmt::format("channel {}, which is none of 1 to {}", message.channel, midi_channels);
    if (!is_bend && (message.number < 0 || message.number > most_midi_value))
        return fmt::format("number {}, which is none of 0 to {}", message.number, most_midi_value);
    const int least = is_bend ? least_bend : 0, most = is_bend ? most_bend : most_midi_value;
    if (message.value < least || message.value > most)
        return fmt::format("value {}, which is none of {} to {}", message.value, least, most);
    return "";
}

std::optional<MidiControl> parse_midi_control(std::string_view name) {
    MidiControl control;
    if (take_midi_word(name, "note "))
        control.kind = MidiKind::note;
    else if (take_midi_word(name, "cc "))
        control.kind = MidiKind::controller;
    else if (take_midi_word(name, "bend"))
        control.kind = MidiKind::bend;
    else
        return std::nullopt;
    if (control.kind != MidiKind::bend) {
        const std::optional<int> number = take_midi_number(name, 0, most_midi_value);
        if (!number) return std::nullopt;
        control.number = *number;
    }
    if (take_midi_word(name, " ch ")) {
        const std::optional<int> channel = take_midi_number(name, 1, midi_channels);
        if (!channel) return std::nullopt;
        control.channel = *channel;
    }
    if (!name.empty()) return std::nullopt;
    return control;
}

std::string to_text(const MidiControl& control) {
    std::string text = control.kind == MidiKind::bend   ? "bend"
                       : control.kind == MidiKind::note ? fmt::format("note {}", control.number)
                                                        : fmt::format("cc {}", control.number);
    if (control.channel != 0) text += fmt::format(" ch {}", control.channel);
    return text;
}

MidiMap MidiMap::read(std::string_view text, const std::filesystem::path& name) {
    MidiMap map;
    read_toml_text(text, name, midi_map_version, [&](TomlTable& top) {
        top.read_table("buttons", [&](TomlTable& table) {
            for (const std::string& key : table.keys()) {
                const MidiControl control = read_midi_control(table, key);
                if (control.kind == MidiKind::bend)
                    table.refuse(key, "is no button: put it under [axes]");
                std::string action;
                table.read(key, action);
                keep_midi(map.buttons_, control, read_button_map(table, key, action), table, key);
            }
        });
        top.read_named_tables("axes", [&](const std::string& key, TomlTable& table) {
            const MidiControl control = read_midi_control(table, key);
            keep_midi(map.axes_, control, read_midi_axis(control, key, table), table, key);
            if (map.buttons_.contains(control))
                table.refuse("action", fmt::format("is of {}, a button already", key));
        });
        top.read_named_tables("lamps", [&](const std::string& key, TomlTable& table) {
            map.lamps_.push_back(read_midi_lamp(read_midi_control(table, key), table));
        });
    });
    return map;
}

MidiMap MidiMap::load(const std::filesystem::path& path) {
    if (path.empty()) {
        const EmbeddedText& standard = embedded_midi().front();
        return read(standard.text, fmt::format("hw_config/midi/{}", standard.name));
    }
    return read(read_text_file(path, most_midi_map_bytes), path);
}

const ButtonMap* MidiMap::find_button(const MidiMessage& message) const {
    return find_midi(buttons_, message);
}

const MidiAxisMap* MidiMap::find_axis(const MidiMessage& message) const {
    return find_midi(axes_, message);
}

}  // namespace vantage
