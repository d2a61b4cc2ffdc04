#pragma once

#include <filesystem>

#include "common/image/image.h"

namespace vantage {

/// Forms of a disparity file, chosen by the extension.
enum class DisparityForm {
    pfm,  ///< .pfm: float pixels, +infinity = unknown
    png,  ///< .png: 16-bit codes in 1/32 px, 0 = unknown
};

/// Throws Error that lists the forms if the extension names none.
DisparityForm disparity_form(const std::filesystem::path& path);

/// Writes in the form of the path's extension, whole or not at all.
void write_disparity(const std::filesystem::path& path, const DisparityImage& disparity);

}  // namespace vantage
