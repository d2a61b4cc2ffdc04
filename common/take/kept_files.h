#pragma once

#include <cstdint>
#include <ctime>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vantage {

/// A recording of one rig in a folder: the rig's own, or one that a host has fetched from it.
struct KeptFile {
    std::filesystem::path path;
    std::filesystem::file_time_type written;
    std::uint64_t bytes = 0;
};

/// A file name that sorts by time: "north-20261122T201500Z.mkv".
std::string kept_file_name(const std::string& rig, std::time_t begin);
/// The begin of a recording, from its name; empty if the name is not one of the rig's.
std::optional<std::time_t> begin_of_kept_file(const std::filesystem::path& path,
                                              const std::string& rig);

/// The rig's recordings in a folder, oldest first; none if the folder does not exist.
std::vector<KeptFile> kept_files(const std::filesystem::path& folder, const std::string& rig);

}  // namespace vantage
