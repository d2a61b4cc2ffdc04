#pragma once

#include <memory>
#include <ostream>
#include <vector>

#include "host_app/control/hid/jog_family.h"

namespace vantage {

inline std::unique_ptr<JogDecoder> decoder_of(const char* id) {
    return make_known_decoder(parse_jog_id(id));
}

/// The events of one report; none if it is refused.
inline std::vector<JogEvent> decoded(JogDecoder& decoder, std::vector<std::uint8_t> report) {
    std::vector<JogEvent> events;
    decoder.decode(report, events);
    return events;
}
inline bool takes(JogDecoder& decoder, std::vector<std::uint8_t> report) {
    std::vector<JogEvent> events;
    return decoder.decode(report, events);
}

inline JogEvent step(const char* control, double value) { return {JogKind::step, control, value}; }
inline JogEvent axis(const char* control, double value) { return {JogKind::axis, control, value}; }
inline JogEvent press(const char* control) { return {JogKind::button, control, 1}; }
inline JogEvent let_go(const char* control) { return {JogKind::button, control, 0}; }

inline void PrintTo(const JogEvent& event, std::ostream* out) {
    *out << event.control << ' ' << event.value;
}

}  // namespace vantage
