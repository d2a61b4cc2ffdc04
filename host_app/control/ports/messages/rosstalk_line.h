#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vantage {

/// A RossTalk command of those that say what is to be done and not how: GPI n, XPT D:S.
struct RossTalkOrder {
    enum class Kind { gpi, xpt } kind = Kind::gpi;
    int first = 0, second = 0;  ///< the number; destination and source
    bool operator==(const RossTalkOrder&) const = default;
};

/// What a line says, without its end. Nothing: it is no such command (case counts), and `is_known`
/// whether it begins as one does.
struct RossTalkLine {
    std::optional<RossTalkOrder> order;
    bool is_known = false;
};
RossTalkLine parse_rosstalk(std::string_view line);

}  // namespace vantage
