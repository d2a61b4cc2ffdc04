#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "common/image/image.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/views/depth_view.h"

namespace vantage {

/// Images of one instant from calibrated cameras, some with depth: a folder with a views.json in
/// this form:
///
///   {"version": 1, "views": [{
///     "name": "left",                 unique
///     "image": "left.png",            8-bit colour, path relative to the folder
///     "K": [[fx,s,cx],[0,fy,cy],[0,0,1]],               of the picture, px
///     "world_from_camera": [[..4],[..4],[..4]],         rigid, metres
///     "disparity": "left.pfm"         or "depth": "left.png"; neither: no geometry
///     "outline": "left_outline.png",  white where the foreground is; optional
///     "scale": 0.25,                  file value * scale = px of the image, or metres; optional
///                                     for PFM
///     "unknown": 0,                   file value for unknown; PFM: not finite is unknown
///     "baseline_m": 0.1,              with disparity
///     "doffs_px": 52                  with disparity, 0 if left out: z = fx * baseline / (d +
///   }]}                               doffs)
///
/// A disparity or depth map of another size than its image has the same field of view.
struct ViewSet {
    std::vector<DepthView> views;
    std::vector<GreyImage> outlines;  ///< of each view, in its picture's size; empty: none

    /// Throws Error with the known names.
    std::size_t index_of(std::string_view name) const;
};

/// Throws Error naming the file, the view and the key for missing or invalid values. Unknown keys
/// are logged and ignored.
ViewSet load_view_set(const std::filesystem::path& folder);

/// Reads an outline: above 127 where the foreground is. Throws Error, with the view's name, if it
/// is of another size.
GreyImage read_outline(const std::filesystem::path& file, const std::string& view, cv::Size size);

/// Loads a camera for `vantage render --pose`: JSON or TOML (by extension) with the keys width,
/// height, K and world_from_camera in the form of views.json. Throws Error likewise.
VirtualView load_virtual_view(const std::filesystem::path& file);

}  // namespace vantage
