#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace vantage {

/// The file or all files of the folder of this name; where neither exists, the files whose names
/// match its last part as a shell pattern ('left*.png'). In natural order. Throws Error if there is
/// none.
std::vector<std::filesystem::path> expand_pictures(const std::string& pattern);

/// Natural order, in which numbers within a text count as numbers: left2 before left10.
bool is_naturally_before(const std::string& a, const std::string& b);

/// The files of several patterns, each file once: a shell that expands a pattern itself hands over
/// the files one by one.
std::vector<std::filesystem::path> expand_pictures(const std::vector<std::string>& patterns);

struct PicturePairs {
    std::vector<std::pair<std::filesystem::path, std::filesystem::path>> pairs;
    std::vector<std::filesystem::path> alone;  ///< without a partner of the same number
};

/// Pairs by the number in the names where every name has one that no other name of its side has;
/// else by order. Throws Error if neither is possible.
PicturePairs pair_pictures(const std::vector<std::filesystem::path>& left,
                           const std::vector<std::filesystem::path>& right);

/// The number that tells the pictures of one series apart, one for each file; empty if there is
/// none.
std::vector<long long> picture_numbers(const std::vector<std::filesystem::path>& files);

}  // namespace vantage
