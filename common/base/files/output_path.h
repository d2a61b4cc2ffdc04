#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>

namespace vantage {

/// Throws Error, before any work is done, if `output` cannot be written (it is a folder, or its
/// folder is missing or closed to this user) or is the same file as one of `others`: an input that
/// would be lost, or a second output.
void require_writable_output(const std::filesystem::path& output,
                             std::initializer_list<std::filesystem::path> others);

/// The path, or, where there is such a file, the first of NAME-2.EXT, NAME-3.EXT, ... that is free.
std::filesystem::path free_path(const std::filesystem::path& path);

/// "take-2026-11-22-201500.mkv", by this process's clock and zone.
std::filesystem::path name_for_now(const std::string& stem, const std::string& extension);

}  // namespace vantage
