#pragma once

#include <string>

#include "common/config/toml_reader.h"

namespace vantage {

/// Reads the key 'name': 1 to 64 letters, digits, '-' and '_', since it is used in file names and
/// message topics. The key is required if `name`, its default, is empty.
void read_stream_name(TomlTable& table, std::string& name);

/// Throws Error with file and line if the value of `key` is not an endpoint (see parse_endpoint).
void check_endpoint(const TomlTable& table, std::string_view key, const std::string& endpoint);

}  // namespace vantage
