#pragma once

#include <nlohmann/json_fwd.hpp>

namespace vantage {

/// Prints a command's result to stdout: one JSON object on one line with `as_json`, otherwise one
/// line per key, without nested values.
void print_result(const nlohmann::ordered_json& result, bool as_json);

}  // namespace vantage
