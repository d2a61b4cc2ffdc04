#pragma once

#include <memory>
#include <optional>

#include "common/gl/buffer.h"
#include "host_app/instants/depth_picture.h"

namespace vantage {

/// The farthest steady depth and colour that one rig has seen, of its depth map's size, and the
/// coarse grid's triangles. The colour's alpha is how well the pixel is confirmed; 0: nothing was
/// learnt. Immutable once the instant that it belongs to is published.
class RigPlate {
  public:
    const DepthPicture& picture() const { return picture_; }
    /// To draw into.
    DepthPicture& picture(cv::Size size) {
        picture_.resize(size);
        has_triangles_ = false;
        return picture_;
    }

    /// Of the coarse grid; the one who publishes it writes them.
    const Buffer& triangles() const { return *triangles_; }
    bool has_triangles() const { return has_triangles_; }
    const Buffer& triangles_to_build(int indices) {
        const std::size_t bytes = static_cast<std::size_t>(indices) * sizeof(std::uint32_t);
        if (!triangles_ || triangle_bytes_ != bytes) triangles_.emplace(bytes, GL_DYNAMIC_DRAW);
        triangle_bytes_ = bytes;
        has_triangles_ = true;
        return *triangles_;
    }

  private:
    DepthPicture picture_;
    bool has_triangles_ = false;
    std::size_t triangle_bytes_ = 0;
    std::optional<Buffer> triangles_;
};

}  // namespace vantage
