#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace vantage {

/// Files that match a shell pattern ('left*.png'), or all files of a folder; in natural order
/// (left2 before left10). Throws Error if nothing matches.
std::vector<std::filesystem::path> expand_pictures(const std::string& pattern);

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
