#pragma once

#include <string>

namespace vantage {

enum class JogKind {
    step,    ///< detents since the previous event; positive is clockwise
    axis,    ///< position of a spring-centred control, -1..1, 0 at rest
    button,  ///< 1 pressed, 0 released
};

/// Operator input on a device: the control, by the name its decoder gives it, and its value.
struct JogEvent {
    JogKind kind = JogKind::step;
    std::string control;
    double value = 0;

    bool operator==(const JogEvent&) const = default;
};

/// One control of a device.
struct JogControl {
    JogKind kind = JogKind::step;
    std::string name;
};

}  // namespace vantage
