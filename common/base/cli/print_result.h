#pragma once

#include <nlohmann/json_fwd.hpp>

namespace vantage {

/// Writes a command's result to stdout: as one JSON object on one line for machines, else a line a
/// key for people (nested values are left to machines).
void print_result(const nlohmann::ordered_json& result, bool as_json);

}  // namespace vantage
