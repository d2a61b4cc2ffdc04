#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace vantage {

/// Sets a key of a TOML document to `value` (TOML: `"name"`, `3`) and keeps everything else,
/// including comments and order. An existing key gets the new value; a new key goes below its
/// table's header; a missing table is added at the end. `table`: "stream", "axes.jog"; empty: the
/// top. `name` stands for the document in errors. Throws Error if the text is not TOML, or the
/// table has a form without a header, such as an array of tables.
std::string with_toml_value(std::string_view text, std::string_view table, std::string_view key,
                            std::string_view value, const std::filesystem::path& name);

/// Removes a key; returns the text unchanged if it has none.
std::string without_toml_key(std::string_view text, std::string_view table, std::string_view key,
                             const std::filesystem::path& name);

/// Formats a TOML string. Precondition: no control characters.
std::string toml_string(const std::string& text);

/// Why a text is not valid as a name given by a person: "is longer than 40 bytes"; empty if valid.
std::string fault_of_name(const std::string& name);

}  // namespace vantage
