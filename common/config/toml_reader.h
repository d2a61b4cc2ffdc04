#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <toml++/toml.h>

namespace vantage {

/// The limits of a value, both included.
template <class T>
struct Range {
    T least = std::numeric_limits<T>::lowest();
    T most = std::numeric_limits<T>::max();
};

/// Reads one table of a TOML file strictly. The program asks for every key it knows with read() or
/// require(); finish() refuses keys of the file that were never asked for. All faults are thrown as
/// Error with file, line and the valid values. A key that the file lacks leaves its value
/// unchanged.
class TomlTable {
  public:
    TomlTable(const toml::table& table, std::string name, const std::filesystem::path& file);

    void read(std::string_view key, bool& value);
    void read(std::string_view key, int& value, Range<int> range = {});
    void read(std::string_view key, std::uint64_t& value);
    /// Also takes integers; never infinity or NaN.
    void read(std::string_view key, double& value, Range<double> range = {});
    void read(std::string_view key, std::string& value);
    /// An array of exactly as many numbers as `values` holds.
    void read(std::string_view key, std::span<double> values, Range<double> range = {});
    /// A table with any names and integer values.
    void read(std::string_view key, std::map<std::string, int>& values);
    /// An array of integers of any length.
    void read(std::string_view key, std::vector<int>& values, Range<int> range = {});
    /// An array of strings.
    void read(std::string_view key, std::vector<std::string>& values);
    /// A path; a relative one is relative to the file's folder.
    void read(std::string_view key, std::filesystem::path& value);
    /// A string that is one of `choices`.
    void read_choice(std::string_view key, std::string& value,
                     std::initializer_list<std::string> choices);

    /// Reads `old_name` as `name` from now on, with a warning if the file has it. For keys that
    /// were renamed. Throws Error if the file has both. Call it before read().
    void rename(std::string_view old_name, std::string_view name);
    /// Requires a key. Call it after read().
    void require(std::string_view key);
    bool has(std::string_view key) const;
    /// All keys, for tables with arbitrary keys.
    std::vector<std::string> keys() const;
    /// Ignores keys that were never asked for, since another program uses them.
    void leave_others();

    /// A sub-table; calls read_members only if the file has it.
    void read_table(std::string_view key, const std::function<void(TomlTable&)>& read_members);
    /// All sub-tables of a table, [key.NAME], with any names, in their order.
    void read_named_tables(
        std::string_view key,
        const std::function<void(const std::string& name, TomlTable&)>& read_members);
    /// All tables of an array of tables, in order.
    void read_tables(std::string_view key, const std::function<void(TomlTable&)>& read_members);

    /// Throws Error "FILE:LINE: 'key' in [table] <what>", for checks of the caller.
    [[noreturn]] void refuse(std::string_view key, std::string_view what) const;

    /// "FILE:LINE" of a key, or of the table if the key is missing.
    std::string place(std::string_view key) const;

    /// Refuses keys that were never asked for, and required keys that are missing.
    void finish() const;

  private:
    /// The name under which the file has a key.
    std::string_view name_in_file(std::string_view key) const;
    const toml::node* find(std::string_view key);
    [[noreturn]] void refuse_type(std::string_view key, const toml::node& node,
                                  std::string_view wanted) const;
    template <class T>
    void check_range(std::string_view key, T value, Range<T> range) const;

    const toml::table* table_;
    std::string name_;
    std::filesystem::path file_;
    std::vector<std::string> known_;
    std::vector<std::pair<std::string, std::string>> renamed_;  ///< new name, old name in the file
    std::vector<std::string> missing_;
};

/// Reads a TOML file with `version = VERSION` at its top. Throws Error if it is missing, larger
/// than 1 MiB, not TOML, of another version, or has a key that read_members does not read.
void read_toml_file(const std::filesystem::path& path, int version,
                    const std::function<void(TomlTable&)>& read_members);

/// The same for a text in memory; `name` stands for the file in errors.
void read_toml_text(std::string_view text, const std::filesystem::path& name, int version,
                    const std::function<void(TomlTable&)>& read_members);

}  // namespace vantage
