#pragma once

#include <filesystem>
#include <string>

namespace vantage {

/// For a camera's node that this user may not open: the sentence that says so, with the mend.
std::string camera_access_sentence(const std::filesystem::path& node);

/// That sentence for the first node of a camera in /dev that this user may not open; empty where
/// all may be. libcamera leaves out such cameras without a word.
std::string forbidden_camera();

}  // namespace vantage
