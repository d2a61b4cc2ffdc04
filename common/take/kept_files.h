#pragma once

#include <cstdint>
#include <ctime>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vantage {

/// A take of one rig in a folder of such: those that a rig keeps for itself, and those that a host
/// has fetched of them.
struct KeptFile {
    std::filesystem::path path;
    std::filesystem::file_time_type written;
    std::uint64_t bytes = 0;
};

/// "north-20261122T201500Z.mkv": in the order of time by name.
std::string kept_file_name(const std::string& rig, std::time_t begin);
/// When it begins, by its name; nothing if the name is none of the rig's.
std::optional<std::time_t> begin_of_kept_file(const std::filesystem::path& path,
                                              const std::string& rig);

/// The rig's files, those written first come first. A folder that is not there has none.
std::vector<KeptFile> kept_files(const std::filesystem::path& folder, const std::string& rig);

}  // namespace vantage
