#pragma once

#include <filesystem>
#include <string>

namespace vantage {

/// Error sentence for a camera node that this user may not open, with the mend.
std::string camera_access_sentence(const std::filesystem::path& node);

/// Error sentence for the first camera node in /dev that this user may not open; empty if there is
/// none. libcamera silently leaves out such cameras.
std::string forbidden_camera();

}  // namespace vantage
