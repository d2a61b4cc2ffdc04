#include "common/image/picture_list.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <set>

#include <fnmatch.h>
#include <glob.h>

#include "common/base/error.h"

namespace vantage {
namespace {

constexpr std::size_t max_pictures = 10000;

/// Text and numbers in turn: "left2b" -> ("left", 2), ("b", -1).
std::vector<std::pair<std::string, long long>> natural_key(const std::string& name) {
    std::vector<std::pair<std::string, long long>> key;
    std::size_t i = 0;
    while (i < name.size()) {
        std::string text, digits;
        while (i < name.size() && !std::isdigit(static_cast<unsigned char>(name[i])))
            text += name[i++];
        while (i < name.size() && std::isdigit(static_cast<unsigned char>(name[i])))
            digits += name[i++];
        // A longer run of digits than any picture number is a serial number: its tail tells.
        if (digits.size() > 18) digits = digits.substr(digits.size() - 18);
        key.emplace_back(text, digits.empty() ? -1 : std::stoll(digits));
    }
    return key;
}

std::vector<long long> numbers_in(const std::filesystem::path& file) {
    std::vector<long long> numbers;
    for (const auto& [text, number] : natural_key(file.stem().string()))
        if (number >= 0) numbers.push_back(number);
    return numbers;
}

void sort_naturally(std::vector<std::filesystem::path>& files) {
    std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) {
        const std::string name_a = a.filename().string(), name_b = b.filename().string();
        return name_a == name_b ? a < b : is_naturally_before(name_a, name_b);
    });
}

using Paths = std::vector<std::filesystem::path>;

bool is_hidden(const std::filesystem::path& file) {
    return file.filename().string().starts_with('.');
}

/// The files of a folder, of whatever name, that `is_wanted`.
Paths files_in(const std::filesystem::path& folder, auto is_wanted) {
    Paths files;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        std::error_code ignored;
        if (entry.is_regular_file(ignored) && is_wanted(entry.path()))
            files.push_back(entry.path());
    }
    if (error) fail("cannot list the folder {}: {}", folder.string(), error.message());
    return files;
}

/// The files that a pattern of the shell matches in each of its parts.
Paths files_by_glob(const std::string& pattern) {
    glob_t found{};
    const int status = ::glob(pattern.c_str(), GLOB_TILDE, nullptr, &found);
    Paths files;
    std::error_code ignored;
    if (status == 0)
        for (std::size_t i = 0; i < found.gl_pathc; ++i)
            if (std::filesystem::is_regular_file(found.gl_pathv[i], ignored))
                files.emplace_back(found.gl_pathv[i]);
    ::globfree(&found);
    return files;
}

/// The parts around the number of a name such as "left%d.png" or "left_%04d.png"; empty without
/// one.
std::optional<std::pair<std::string, std::string>> parts_around_number(const std::string& name) {
    const std::size_t begin = name.find('%');
    if (begin == std::string::npos) return std::nullopt;
    std::size_t end = begin + 1;
    if (end < name.size() && name[end] == '0') ++end;
    while (end < name.size() && std::isdigit(static_cast<unsigned char>(name[end]))) ++end;
    if (end >= name.size() || name[end] != 'd') return std::nullopt;
    return std::pair(name.substr(0, begin), name.substr(end + 1));
}

bool has_number_between(const std::string& name, const std::string& before,
                        const std::string& after) {
    return name.size() > before.size() + after.size() && name.starts_with(before) &&
           name.ends_with(after) &&
           std::all_of(name.begin() + static_cast<std::ptrdiff_t>(before.size()),
                       name.end() - static_cast<std::ptrdiff_t>(after.size()),
                       [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// A name that exists is that file or folder, whatever characters it has. Else the last part is the
/// pattern, in a folder that exists under the name before it.
Paths files_named(const std::string& name) {
    const std::filesystem::path path(name);
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        return files_in(path, [](const auto& file) { return !is_hidden(file); });
    if (std::filesystem::is_regular_file(path, ignored)) return {path};
    const std::filesystem::path folder = path.parent_path();
    if (!std::filesystem::is_directory(folder.empty() ? "." : folder, ignored))
        return files_by_glob(name);
    const std::string pattern = path.filename().string();
    Paths files = files_in(folder.empty() ? "." : folder, [&](const auto& file) {
        return ::fnmatch(pattern.c_str(), file.filename().c_str(), FNM_PERIOD) == 0;
    });
    // Numbered pictures, as the source of a rig names them.
    if (const auto parts = parts_around_number(pattern); files.empty() && parts)
        files = files_in(folder.empty() ? "." : folder, [&](const auto& file) {
            return has_number_between(file.filename().string(), parts->first, parts->second);
        });
    if (folder.empty())
        for (std::filesystem::path& file : files) file = file.filename();
    return files;
}

}  // namespace

bool is_naturally_before(const std::string& a, const std::string& b) {
    const auto key_a = natural_key(a), key_b = natural_key(b);
    return key_a == key_b ? a < b : key_a < key_b;
}

std::vector<std::filesystem::path> expand_pictures(const std::string& pattern) {
    Paths files = files_named(pattern);
    if (files.empty()) fail("no file matches '{}'", pattern);
    if (files.size() > max_pictures)
        fail("'{}' matches {} files; up to {} are taken", pattern, files.size(), max_pictures);
    sort_naturally(files);
    return files;
}

std::vector<std::filesystem::path> expand_pictures(const std::vector<std::string>& patterns) {
    std::set<std::filesystem::path> distinct;
    for (const std::string& pattern : patterns)
        for (std::filesystem::path& file : expand_pictures(pattern))
            distinct.insert(std::move(file));
    std::vector<std::filesystem::path> files(distinct.begin(), distinct.end());
    sort_naturally(files);
    return files;
}

std::vector<long long> picture_numbers(const std::vector<std::filesystem::path>& files) {
    std::vector<std::vector<long long>> numbers;
    for (const auto& file : files) numbers.push_back(numbers_in(file));
    std::size_t count = numbers.empty() ? 0 : numbers.front().size();
    for (const auto& n : numbers) count = std::min(count, n.size());
    // The last number of a name is most often the picture's; the first may name the camera.
    for (std::size_t from_end = 1; from_end <= count; ++from_end) {
        std::vector<long long> chosen;
        for (const auto& n : numbers) chosen.push_back(n[n.size() - from_end]);
        if (std::set<long long>(chosen.begin(), chosen.end()).size() == chosen.size())
            return chosen;
    }
    return {};
}

PicturePairs pair_pictures(const std::vector<std::filesystem::path>& left,
                           const std::vector<std::filesystem::path>& right) {
    PicturePairs result;
    const std::vector<long long> left_numbers = picture_numbers(left);
    const std::vector<long long> right_numbers = picture_numbers(right);
    if (!left_numbers.empty() && !right_numbers.empty()) {
        std::map<long long, std::filesystem::path> partners;
        for (std::size_t i = 0; i < right.size(); ++i) partners[right_numbers[i]] = right[i];
        for (std::size_t i = 0; i < left.size(); ++i) {
            const auto partner = partners.find(left_numbers[i]);
            if (partner == partners.end()) {
                result.alone.push_back(left[i]);
            } else {
                result.pairs.emplace_back(left[i], partner->second);
                partners.erase(partner);
            }
        }
        for (const auto& [number, file] : partners) result.alone.push_back(file);
        if (!result.pairs.empty()) return result;
        result = {};
    }
    if (left.size() != right.size())
        fail(
            "{} left and {} right pictures cannot be paired: give the pictures of a pair the same "
            "number in their names",
            left.size(), right.size());
    for (std::size_t i = 0; i < left.size(); ++i) result.pairs.emplace_back(left[i], right[i]);
    return result;
}

}  // namespace vantage
