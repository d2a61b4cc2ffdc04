#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace vantage {

/// `text`, a TOML document, with `key` of a table set to `value` (TOML: `"name"`, `3`), and all
/// else as it stands, comments and order too. A key that is there gets the value in place of its
/// own; another is put below its table's header, of a table that the document lacks at its end.
/// `table`: "stream", "axes.jog"; empty: the top. `name` stands for the document in what is
/// refused. Throws Error for what is no TOML, and for a table whose form leaves no place for a key
/// ([table] can hold one, an array of tables cannot).
std::string with_toml_value(std::string_view text, std::string_view table, std::string_view key,
                            std::string_view value, const std::filesystem::path& name);

/// `text` without the key; as it is if it has none.
std::string without_toml_key(std::string_view text, std::string_view table, std::string_view key,
                             const std::filesystem::path& name);

}  // namespace vantage
