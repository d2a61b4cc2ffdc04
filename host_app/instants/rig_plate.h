#pragma once

#include <memory>
#include <optional>

#include "host_app/instants/depth_grid.h"
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
        return picture_;
    }

    /// Of the coarse grid; the one who publishes it writes them.
    const IndirectTriangles& triangles() const { return *triangles_; }
    const IndirectTriangles& triangles_to_build(int most_indices) {
        if (!triangles_ || triangles_->capacity != most_indices) triangles_.emplace(most_indices);
        return *triangles_;
    }

  private:
    DepthPicture picture_;
    std::optional<IndirectTriangles> triangles_;
};

}  // namespace vantage
