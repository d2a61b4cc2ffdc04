#pragma once

#include <string>

#include "common/config/toml_reader.h"

namespace vantage {

/// Reads the required key 'name': 1 to 64 letters, digits, '-' and '_', since it names a rig in
/// file names and message topics.
void read_stream_name(TomlTable& table, std::string& name);

/// Refuses a value of `key` that is no endpoint (see parse_endpoint), with file and line.
void check_endpoint(const TomlTable& table, std::string_view key, const std::string& endpoint);

}  // namespace vantage
