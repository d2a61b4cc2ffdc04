#pragma once

#include <functional>
#include <vector>

#include <opencv2/core/types.hpp>

#include "common/gl/objects/program.h"

namespace vantage {

/// A camera's buffer as textures that are not converted yet, for RectifyPass. The textures belong
/// to the maker, who says how long they live.
struct RawPlanes {
    int shader_format;                     ///< FORMAT of shaders/capture/camera_formats.glsl
    cv::Size size;                         ///< of the picture
    int first_column_px;                   ///< of the picture in its buffer
    std::vector<cv::Size> plane_sizes;     ///< in texels
    std::function<void(Program&)> inputs;  ///< makes the planes the inputs "raw" and "chroma"
};

}  // namespace vantage
