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
#include <vector>

#include <toml++/toml.h>

namespace vantage {

/// Limits of a value, both included.
template <class T>
struct Range {
    T least = std::numeric_limits<T>::lowest();
    T most = std::numeric_limits<T>::max();
};

/// One table of a TOML file, read strictly. Every key the program knows is asked for with read() or
/// require(); a key of the file that was never asked for is refused. All faults are thrown as Error
/// with file, line and what is wanted. Values that the file leaves out keep what they hold.
class TomlTable {
  public:
    TomlTable(const toml::table& table, std::string name, const std::filesystem::path& file);

    void read(std::string_view key, bool& value);
    void read(std::string_view key, int& value, Range<int> range = {});
    void read(std::string_view key, std::uint64_t& value);
    /// Integers are taken too; infinity and NaN never.
    void read(std::string_view key, double& value, Range<double> range = {});
    void read(std::string_view key, std::string& value);
    /// Exactly as many numbers as `values` holds.
    void read(std::string_view key, std::span<double> values, Range<double> range = {});
    /// A table of names and integers, whatever the names.
    void read(std::string_view key, std::map<std::string, int>& values);
    /// An array of integers, however many.
    void read(std::string_view key, std::vector<int>& values, Range<int> range = {});
    /// An array of strings.
    void read(std::string_view key, std::vector<std::string>& values);
    /// A path; a relative one is relative to the folder of the file.
    void read(std::string_view key, std::filesystem::path& value);
    /// A string that is one of `choices`.
    void read_choice(std::string_view key, std::string& value,
                     std::initializer_list<std::string> choices);

    /// After read(): the key must be there.
    void require(std::string_view key);
    bool has(std::string_view key) const;
    /// Of a table whose keys are whatever the file names.
    std::vector<std::string> keys() const;
    /// Keys that are never asked for are no fault: they are somebody else's.
    void leave_others();

    /// A table of this table; read_members is called only if the file has it.
    void read_table(std::string_view key, const std::function<void(TomlTable&)>& read_members);
    /// Every table of a table of tables, [key.NAME], whatever the names, in their order.
    void read_named_tables(
        std::string_view key,
        const std::function<void(const std::string& name, TomlTable&)>& read_members);
    /// Every table of an array of tables, in the file's order.
    void read_tables(std::string_view key, const std::function<void(TomlTable&)>& read_members);

    /// Throws Error "FILE:LINE: 'key' in [table] <what>", for limits of the caller's own.
    [[noreturn]] void refuse(std::string_view key, std::string_view what) const;

    /// "FILE:LINE" of a key, or of the table if it has none such.
    std::string place(std::string_view key) const;

    /// Refuses keys that were never asked for, then keys that are required and missing.
    void finish() const;

  private:
    const toml::node* find(std::string_view key);
    [[noreturn]] void refuse_type(std::string_view key, const toml::node& node,
                                  std::string_view wanted) const;
    template <class T>
    void check_range(std::string_view key, T value, Range<T> range) const;

    const toml::table* table_;
    std::string name_;
    std::filesystem::path file_;
    std::vector<std::string> known_;
    std::vector<std::string> missing_;
};

/// Reads a TOML file whose top has `version = VERSION`. Throws Error if it is missing, larger than
/// 1 MiB, not TOML, of another version, or if read_members leaves a key of it unread.
void read_toml_file(const std::filesystem::path& path, int version,
                    const std::function<void(TomlTable&)>& read_members);

/// The same for a text in memory; `name` stands for the file in what is refused.
void read_toml_text(std::string_view text, const std::filesystem::path& name, int version,
                    const std::function<void(TomlTable&)>& read_members);

}  // namespace vantage
