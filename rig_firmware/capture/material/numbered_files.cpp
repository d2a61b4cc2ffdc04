#include "rig_firmware/capture/material/numbered_files.h"

#include <charconv>
#include <optional>
#include <regex>
#include <set>
#include <string_view>

#include "common/base/error.h"

namespace vantage {
namespace {

constexpr int max_digits = 9;

/// Number between the fixed parts of a file name; empty unless it is written as the pattern would
/// write it.
std::optional<int> number_in(std::string_view name, std::string_view before,
                             std::string_view after) {
    if (name.size() <= before.size() + after.size() || !name.starts_with(before) ||
        !name.ends_with(after))
        return std::nullopt;
    const std::string_view digits =
        name.substr(before.size(), name.size() - before.size() - after.size());
    int number = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (error != std::errc{} || end != digits.data() + digits.size() || number < 0)
        return std::nullopt;
    return number;
}

}  // namespace

bool NumberedFiles::is_pattern(const std::filesystem::path& path) {
    std::error_code ignored;
    return path.filename().string().find('%') != std::string::npos &&
           !std::filesystem::exists(path, ignored);
}

NumberedFiles::NumberedFiles(const std::filesystem::path& pattern)
    : folder_(pattern.parent_path().empty() ? "." : pattern.parent_path()) {
    static const std::regex one_number("([^%]*)%(?:0([1-9]))?d([^%]*)");
    std::smatch parts;
    const std::string name = pattern.filename().string();
    if (!std::regex_match(name, parts, one_number))
        fail(
            "there is no file {}, and as a pattern for numbered pictures its name must have one "
            "%d or %04d and no other '%'",
            pattern.string());
    before_ = parts[1];
    digits_ = parts[2].matched ? parts[2].str()[0] - '0' : 1;
    after_ = parts[3];
}

std::filesystem::path NumberedFiles::path(int number) const {
    return folder_ / fmt::format("{}{:0{}}{}", before_, number, digits_, after_);
}

int NumberedFiles::count_from(int first) const {
    std::set<int> numbers;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder_, error)) {
        const std::string name = entry.path().filename().string();
        const std::optional<int> number = number_in(name, before_, after_);
        if (number && *number >= first && path(*number).filename() == name) numbers.insert(*number);
    }
    if (error) fail("cannot list the folder {}: {}", folder_.string(), error.message());
    if (numbers.empty())
        fail("there is no picture {}, nor one of a higher number", path(first).string());
    int expected = first;
    for (const int number : numbers)
        if (number != expected++)
            fail(
                "the picture {} is missing, and {} is there: give the missing ones, or set 'first'",
                path(expected - 1).string(), path(number).string());
    return expected - first;
}

}  // namespace vantage
