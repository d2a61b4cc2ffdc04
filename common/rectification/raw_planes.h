#pragma once

#include <functional>
#include <vector>

#include <opencv2/core/types.hpp>

namespace vantage {

/// A camera's buffer as textures that are not converted yet, for RectifyPass. The textures belong
/// to the maker, who says how long they live.
struct RawPlanes {
    int shader_format;                  ///< FORMAT of shaders/capture/camera_formats.glsl
    cv::Size size;                      ///< of the picture
    int first_column_px;                ///< of the picture in its buffer
    std::vector<cv::Size> plane_sizes;  ///< in texels
    std::function<void(int)> bind;      ///< binds the planes to texture units from this one on
};

}  // namespace vantage
