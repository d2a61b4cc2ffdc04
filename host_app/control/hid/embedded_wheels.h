#pragma once

#include <span>
#include <string_view>

namespace vantage {

/// A file of hw_config/jog as it was built in.
struct EmbeddedWheel {
    std::string_view name, text;
};
std::span<const EmbeddedWheel> embedded_wheels();

}  // namespace vantage
