#pragma once

#include <string>

#include "common/config/toml_reader.h"

namespace vantage {

/// Reads the required key 'name': 1 to 64 letters, digits, '-' and '_', since it names a rig in
/// file names and message topics.
void read_stream_name(TomlTable& table, std::string& name);

}  // namespace vantage
