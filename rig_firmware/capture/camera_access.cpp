#include "rig_firmware/capture/camera_access.h"

#include <algorithm>
#include <cerrno>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

namespace vantage {

std::string camera_access_sentence(const std::filesystem::path& node) {
    return fmt::format(
        "{} may not be opened by this user: put the user into the group 'video', or install the "
        "udev rules of Vantage (60-vantage-camera.rules)",
        node.string());
}

std::string forbidden_camera() {
    std::vector<std::filesystem::path> nodes;
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator("/dev", ignored)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("media") || name.starts_with("video")) nodes.push_back(entry.path());
    }
    std::sort(nodes.begin(), nodes.end());
    const auto is_forbidden = [](const std::filesystem::path& node) {
        return ::eaccess(node.c_str(), R_OK | W_OK) != 0 && errno == EACCES;
    };
    const auto found = std::find_if(nodes.begin(), nodes.end(), is_forbidden);
    return found == nodes.end() ? std::string() : camera_access_sentence(*found);
}

}  // namespace vantage
