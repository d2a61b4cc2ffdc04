#pragma once

#include <string_view>

namespace vantage {

/// The version of Vantage: "0.2.0".
std::string_view version();

}  // namespace vantage
