#pragma once

#include <string>

namespace vantage {

/// Operator's request to the editor of a wheel's map.
struct WheelCall {
    enum class What {
        select_by,  ///< moves the selection by `amount` controls
        select,     ///< selects the control called `words`
        assign,     ///< assigns `words`, a command or "nothing", to the selected control
        // change the response of the selected control by `amount` small steps
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
