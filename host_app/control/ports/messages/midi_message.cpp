#include "host_app/control/ports/messages/midi_message.h"

#include <charconv>

#include <fmt/format.h>

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

}  // namespace vantage
