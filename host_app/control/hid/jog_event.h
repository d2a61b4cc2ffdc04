#pragma once

#include <string>

namespace vantage {

enum class JogKind {
    step,    ///< turned by so many detents since the event before; positive is clockwise
    axis,    ///< where a spring-centred control stands, -1..1, 0 at rest
    button,  ///< 1 pressed, 0 let go
};

/// What a hand did, whatever the device: the control by the name its decoder gives it.
struct JogEvent {
    JogKind kind = JogKind::step;
    std::string control;
    double value = 0;

    bool operator==(const JogEvent&) const = default;
};

/// A control that a device has.
struct JogControl {
    JogKind kind = JogKind::step;
    std::string name;
};

}  // namespace vantage
