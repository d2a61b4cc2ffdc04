#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vantage {

/// Folder of a rig on the command line: --rig NAME=FOLDER, or FOLDER alone, which is also the name.
struct RigFolder {
    std::string name;
    std::filesystem::path folder;
};

/// calibration.yaml in the folder, or the path itself if it is a file.
std::filesystem::path calibration_file_of(const RigFolder& rig);

/// Throws Error for a name that is empty, contains '/', or is given twice.
std::vector<RigFolder> parse_rig_folders(const std::vector<std::string>& arguments);

}  // namespace vantage
