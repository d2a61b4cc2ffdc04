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

/// Throws Error for a name that is empty, has a '/', or is given twice.
std::vector<RigFolder> parse_rig_folders(const std::vector<std::string>& arguments);

}  // namespace vantage
