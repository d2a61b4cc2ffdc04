#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vantage {

/// RossTalk command that Vantage supports: GPI n, XPT D:S.
struct RossTalkOrder {
    enum class Kind { gpi, xpt } kind = Kind::gpi;
    int first = 0, second = 0;  ///< the number, or destination and source
    bool operator==(const RossTalkOrder&) const = default;
};

/// Result of parsing a line without its end. `order` is empty if the line is not such a command;
/// commands are case-sensitive. `is_known` is true if the line begins like one.
struct RossTalkLine {
    std::optional<RossTalkOrder> order;
    bool is_known = false;
};
RossTalkLine parse_rosstalk(std::string_view line);

}  // namespace vantage
