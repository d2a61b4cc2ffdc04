#include "calib_tools/commands/rig_folders.h"

#include <set>

#include "common/base/error.h"

namespace vantage {

std::filesystem::path calibration_file_of(const RigFolder& rig) {
    // The name of a file that is missing must not look like that of a folder.
    std::error_code ignored;
    const bool is_file =
        std::filesystem::is_regular_file(rig.folder, ignored) ||
        (rig.folder.extension() == ".yaml" && !std::filesystem::is_directory(rig.folder, ignored));
    return is_file ? rig.folder : rig.folder / "calibration.yaml";
}

std::vector<RigFolder> parse_rig_folders(const std::vector<std::string>& arguments) {
    std::vector<RigFolder> rigs;
    std::set<std::string> names;
    for (const std::string& argument : arguments) {
        const std::size_t equals = argument.find('=');
        RigFolder rig;
        rig.folder = equals == std::string::npos ? argument : argument.substr(equals + 1);
        rig.name = equals == std::string::npos ? rig.folder.filename().string()
                                               : argument.substr(0, equals);
        if (rig.name.empty() || rig.name.find('/') != std::string::npos ||
            !names.insert(rig.name).second)
            fail("rig '{}' needs a name of its own without '/': --rig NAME=FOLDER", argument);
        rigs.push_back(rig);
    }
    return rigs;
}

}  // namespace vantage
