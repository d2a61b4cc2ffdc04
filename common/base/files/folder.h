#pragma once

#include <filesystem>

namespace vantage {

/// Makes a folder and those above it; one that is there stays as it is. Throws Error with the path
/// and the system's reason.
void make_folder(const std::filesystem::path& folder);

/// Where Vantage keeps what is this user's: ~/.config/vantage, or below XDG_CONFIG_HOME. Throws
/// Error where this user has no home.
std::filesystem::path user_folder();

}  // namespace vantage
