#pragma once

#include <filesystem>

namespace vantage {

/// Creates a folder and its parents; an existing folder stays as it is. Throws Error with the path
/// and the reason.
void make_folder(const std::filesystem::path& folder);

/// The folder of the user's own settings: ~/.config/vantage, or vantage below XDG_CONFIG_HOME.
/// Throws Error if the user has no home folder.
std::filesystem::path user_folder();

}  // namespace vantage
