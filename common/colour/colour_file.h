#pragma once

#include <filesystem>
#include <string>

#include "common/colour/colour_correction.h"

namespace vantage {

/// How a colour correction was made, for people and for `vantage-calib check`.
struct ColourRecord {
    std::string date, tool, reference;             ///< reference: a rig's name, or "chart"
    double delta_e_before = 0, delta_e_after = 0;  ///< mean CIEDE2000 from the reference
    int samples = 0;
};

/// Loads a colour file (TOML, version 1): matrix (nine numbers, row by row), tone (three numbers)
/// and the record. Throws Error naming the file and the key.
ColourCorrection load_colour(const std::filesystem::path& path);
/// Writes the file atomically; an existing file is kept as PATH.last.
void save_colour(const std::filesystem::path& path, const ColourCorrection& correction,
                 const ColourRecord& record);

}  // namespace vantage
