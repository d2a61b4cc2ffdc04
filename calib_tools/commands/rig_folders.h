#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vantage {

/// A rig's folder on the command line: --rig NAME=FOLDER, or FOLDER alone, whose name it then has.
struct RigFolder {
    std::string name;
    std::filesystem::path folder;
};

/// The folder's calibration.yaml, or what is named itself where that is a file.
std::filesystem::path calibration_file_of(const RigFolder& rig);

/// Throws Error for a name that is empty, has a '/', or is given twice.
std::vector<RigFolder> parse_rig_folders(const std::vector<std::string>& arguments);

}  // namespace vantage
