#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>

namespace vantage {

/// Throws Error if `output` cannot be written (it is a folder, or its folder is missing or not
/// writable), or if it is the same file as one of `others`: an input, or another output. Call it
/// before the work begins.
void require_writable_output(const std::filesystem::path& output,
                             std::initializer_list<std::filesystem::path> others);

/// The path, or the first free one of NAME-2.EXT, NAME-3.EXT, ... if the file exists.
std::filesystem::path free_path(const std::filesystem::path& path);

/// A file name with the local time: "take-2026-11-22-201500.mkv".
std::filesystem::path name_for_now(const std::string& stem, const std::string& extension);

}  // namespace vantage
