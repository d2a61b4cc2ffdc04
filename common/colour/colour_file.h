#pragma once

#include <filesystem>
#include <string>

#include "common/colour/colour_correction.h"

namespace vantage {

/// How a colour correction was made, kept in its file for people and for `check`.
struct ColourRecord {
    std::string date, tool, reference;             ///< reference: a rig's name, or "chart"
    double delta_e_before = 0, delta_e_after = 0;  ///< mean CIEDE2000 from the reference
    int samples = 0;
};

/// A colour file (TOML, version 1): matrix (nine numbers, row by row), tone (three), and the
/// record. Throws Error naming file and key.
ColourCorrection load_colour(const std::filesystem::path& path);
/// Written whole or not at all; a good file that stood there is kept as PATH.last.
void save_colour(const std::filesystem::path& path, const ColourCorrection& correction,
                 const ColourRecord& record);

}  // namespace vantage
