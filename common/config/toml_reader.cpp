#include "common/config/toml_reader.h"

#include <algorithm>
#include <cmath>

#include "common/base/cli/nearest_name.h"
#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/log.h"

namespace vantage {
namespace {

constexpr std::size_t max_file_bytes = 1 << 20;

std::string_view type_name(toml::node_type type) {
    switch (type) {
        case toml::node_type::table:
            return "a table";
        case toml::node_type::array:
            return "an array";
        case toml::node_type::string:
            return "a string";
        case toml::node_type::integer:
            return "an integer";
        case toml::node_type::floating_point:
            return "a number with a fraction";
        case toml::node_type::boolean:
            return "true or false";
        case toml::node_type::none:
            return "nothing";
        default:
            return "a date or time";
    }
}

std::string in_table(const std::string& name) {
    return name.empty() ? std::string() : fmt::format(" in [{}]", name);
}

}  // namespace

TomlTable::TomlTable(const toml::table& table, std::string name, const std::filesystem::path& file)
    : table_(&table), name_(std::move(name)), file_(file) {}

const toml::node* TomlTable::find(std::string_view key) {
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
    return table_->get(name_in_file(key));
}

void TomlTable::rename(std::string_view old_name, std::string_view name) {
    if (!table_->contains(old_name)) return;
    if (table_->contains(name))
        refuse(old_name, fmt::format("is the old name of '{}': keep one", name));
    log_warning("{}: '{}'{} is now called '{}'; the old name will be removed", place(old_name),
                old_name, in_table(name_), name);
    known_.emplace_back(old_name);
    renamed_.emplace_back(name, old_name);
}

std::string_view TomlTable::name_in_file(std::string_view key) const {
    for (const auto& [name, old_name] : renamed_)
        if (name == key) return old_name;
    return key;
}

bool TomlTable::has(std::string_view key) const { return table_->contains(name_in_file(key)); }

std::vector<std::string> TomlTable::keys() const {
    std::vector<std::string> names;
    for (const auto& [name, unused] : *table_) names.emplace_back(name.str());
    return names;
}

void TomlTable::leave_others() {
    for (std::string& key : keys()) known_.push_back(std::move(key));
}

std::string TomlTable::place(std::string_view key) const {
    const auto entry = table_->find(name_in_file(key));
    const toml::source_region& region =
        entry == table_->end() ? table_->source() : entry->first.source();
    return fmt::format("{}:{}", file_.string(), std::max<toml::source_index>(region.begin.line, 1));
}

void TomlTable::refuse(std::string_view key, std::string_view what) const {
    fail("{}: '{}'{} {}", place(key), key, in_table(name_), what);
}

void TomlTable::refuse_type(std::string_view key, const toml::node& node,
                            std::string_view wanted) const {
    refuse(key, fmt::format("must be {}, but is {}", wanted, type_name(node.type())));
}

template <class T>
void TomlTable::check_range(std::string_view key, T value, Range<T> range) const {
    if (value >= range.least && value <= range.most) return;
    if (range.most == std::numeric_limits<T>::max())
        refuse(key, fmt::format("is {}, but must be at least {}", value, range.least));
    refuse(key, fmt::format("is {}, but must be {} to {}", value, range.least, range.most));
}

void TomlTable::read(std::string_view key, bool& value) {
    const toml::node* node = find(key);
    if (!node) return;
    if (!node->is_boolean()) refuse_type(key, *node, "true or false");
    value = node->as_boolean()->get();
}

void TomlTable::read(std::string_view key, int& value, Range<int> range) {
    const toml::node* node = find(key);
    if (!node) return;
    if (!node->is_integer()) refuse_type(key, *node, "an integer");
    const std::int64_t wide = node->as_integer()->get();
    const bool no_upper_limit = range.most == std::numeric_limits<int>::max();
    if (wide < range.least && no_upper_limit)
        check_range<std::int64_t>(key, wide, {.least = range.least});
    check_range<std::int64_t>(key, wide, {range.least, range.most});
    value = static_cast<int>(wide);
}

void TomlTable::read(std::string_view key, std::uint64_t& value) {
    const toml::node* node = find(key);
    if (!node) return;
    if (!node->is_integer()) refuse_type(key, *node, "an integer");
    const std::int64_t signed_value = node->as_integer()->get();
    check_range<std::int64_t>(key, signed_value, {0});
    value = static_cast<std::uint64_t>(signed_value);
}

void TomlTable::read(std::string_view key, double& value, Range<double> range) {
    const toml::node* node = find(key);
    if (!node) return;
    if (!node->is_number()) refuse_type(key, *node, "a number");
    const double number = *node->value<double>();
    if (!std::isfinite(number)) refuse(key, "must be a finite number");
    check_range(key, number, range);
    value = number;
}

void TomlTable::read(std::string_view key, std::string& value) {
    const toml::node* node = find(key);
    if (!node) return;
    if (!node->is_string()) refuse_type(key, *node, "a string");
    value = node->as_string()->get();
}

void TomlTable::read(std::string_view key, std::span<double> values, Range<double> range) {
    const toml::node* node = find(key);
    if (!node) return;
    const std::string wanted = fmt::format("an array of {} numbers", values.size());
    const toml::array* array = node->as_array();
    if (!array) refuse_type(key, *node, wanted);
    if (array->size() != values.size())
        refuse(key, fmt::format("must be {}, but has {}", wanted, array->size()));
    for (std::size_t i = 0; i < values.size(); ++i) {
        const toml::node& element = *array->get(i);
        if (!element.is_number()) refuse_type(key, element, wanted);
        const double number = *element.value<double>();
        if (!std::isfinite(number)) refuse(key, "must hold finite numbers");
        check_range(key, number, range);
        values[i] = number;
    }
}

void TomlTable::read(std::string_view key, std::map<std::string, int>& values) {
    read_table(key, [&](TomlTable& table) {
        for (const auto& [name, unused] : *table.table_)
            table.read(name.str(), values[std::string(name.str())]);
    });
}

void TomlTable::read(std::string_view key, std::vector<int>& values, Range<int> range) {
    const toml::node* node = find(key);
    if (!node) return;
    const toml::array* array = node->as_array();
    if (!array) refuse_type(key, *node, "an array of integers");
    values.clear();
    for (const toml::node& element : *array) {
        if (!element.is_integer()) refuse_type(key, element, "an array of integers");
        const std::int64_t number = element.as_integer()->get();
        check_range(key, number, Range<std::int64_t>{range.least, range.most});
        values.push_back(static_cast<int>(number));
    }
}

void TomlTable::read(std::string_view key, std::vector<std::string>& values) {
    const toml::node* node = find(key);
    if (!node) return;
    const toml::array* array = node->as_array();
    if (!array) refuse_type(key, *node, "an array of strings");
    values.clear();
    for (const toml::node& element : *array) {
        if (!element.is_string()) refuse_type(key, element, "an array of strings");
        values.push_back(element.as_string()->get());
    }
}

void TomlTable::read_named_tables(
    std::string_view key,
    const std::function<void(const std::string& name, TomlTable&)>& read_members) {
    read_table(key, [&](TomlTable& tables) {
        for (const std::string& name : tables.keys())
            tables.read_table(name, [&](TomlTable& table) { read_members(name, table); });
    });
}

void TomlTable::read(std::string_view key, std::filesystem::path& value) {
    std::string text;
    read(key, text);
    if (!has(key)) return;
    if (text.empty()) refuse(key, "must not be empty: leave the key out if there is no such file");
    value = file_.parent_path() / text;
}

void TomlTable::read_choice(std::string_view key, std::string& value,
                            std::initializer_list<std::string> choices) {
    read(key, value);
    if (!has(key) || std::find(choices.begin(), choices.end(), value) != choices.end()) return;
    refuse(key, fmt::format("must not be '{}'; {}", value,
                            suggest_name(value, std::vector<std::string>(choices))));
}

void TomlTable::require(std::string_view key) {
    if (!find(key)) missing_.emplace_back(key);
}

void TomlTable::read_table(std::string_view key,
                           const std::function<void(TomlTable&)>& read_members) {
    const toml::node* node = find(key);
    if (!node) return;
    if (!node->is_table()) refuse_type(key, *node, "a table");
    TomlTable table(*node->as_table(),
                    name_.empty() ? std::string(key) : fmt::format("{}.{}", name_, key), file_);
    read_members(table);
    table.finish();
}

void TomlTable::read_tables(std::string_view key,
                            const std::function<void(TomlTable&)>& read_members) {
    const toml::node* node = find(key);
    if (!node) return;
    const toml::array* array = node->as_array();
    if (!array) refuse_type(key, *node, fmt::format("an array of tables, [[{}]]", key));
    for (const toml::node& element : *array) {
        if (!element.is_table())
            refuse_type(key, element, fmt::format("an array of tables, [[{}]]", key));
        TomlTable table(*element.as_table(), fmt::format("[{}]", key), file_);
        read_members(table);
        table.finish();
    }
}

void TomlTable::finish() const {
    for (const auto& [key, unused] : *table_) {
        if (std::find(known_.begin(), known_.end(), key.str()) != known_.end()) continue;
        fail("{}: there is no key '{}'{}; {}", place(key.str()), key.str(), in_table(name_),
             suggest_name(key.str(), known_));
    }
    if (!missing_.empty()) refuse(missing_.front(), "is missing");
}

void read_toml_file(const std::filesystem::path& path, int version,
                    const std::function<void(TomlTable&)>& read_members) {
    const std::vector<std::byte> bytes = read_file(path, max_file_bytes);
    read_toml_text(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()),
                   path, version, read_members);
}

void read_toml_text(std::string_view text, const std::filesystem::path& path, int version,
                    const std::function<void(TomlTable&)>& read_members) {
    toml::table parsed;
    try {
        parsed = toml::parse(text);
    } catch (const toml::parse_error& error) {
        fail("{}:{}: this is not TOML: {}", path.string(), error.source().begin.line,
             error.description());
    }
    TomlTable table(parsed, "", path);
    int given = version;
    table.read("version", given);
    if (!table.has("version"))
        fail("{}: the key 'version' is missing; put `version = {}` at the top", path.string(),
             version);
    if (given != version)
        table.refuse("version",
                     fmt::format("is {}, but this program reads version {}", given, version));
    read_members(table);
    table.finish();
}

}  // namespace vantage
