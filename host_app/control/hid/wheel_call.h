#pragma once

#include <string>

namespace vantage {

/// What hands ask of the map of a wheel while it is open on the desk.
struct WheelCall {
    enum class What {
        select_by,  ///< `amount` controls on, or back
        select,     ///< the control called `words`
        assign,     ///< `words`, a command or "nothing", to the control in hand
        // How the control in hand feels, by `amount` little steps.
        steps,
        dead_zone,
        curve,
        invert,
        save,
        close,
    };
    What what = What::close;
    int amount = 0;
    std::string words = {};

    bool operator==(const WheelCall&) const = default;
};

}  // namespace vantage
