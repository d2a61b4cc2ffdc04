#pragma once

#include "common/geometry/pose.h"
#include "common/gl/objects/buffer.h"
#include "common/gl/objects/texture.h"

namespace vantage {

/// Pixels of a depth map that a quad of its grid spans; a coarse quad that is cut becomes quads of
/// one pixel.
enum class QuadGrid { fine = 1, coarse = 2 };

/// The number of indices of a depth map's triangles, two for each pixel.
int triangle_indices(cv::Size depth_size);

/// Triangles of a depth map as an indirect draw: only the GPU knows their number.
struct IndirectTriangles {
    Buffer indices, command;
    int capacity;  ///< indices

    explicit IndirectTriangles(int max_indices);
    /// Removes all triangles and prepares for a shader that writes new ones: binds the indices to
    /// storage 0 and the command to storage 1.
    void begin() const;
    /// Draws with the program and the vertex array in use.
    void draw() const;
};

/// A camera's depth map as a grid of quads. Refers to textures and buffers that must outlive it.
struct DepthGrid {
    const Texture& depth_m;  ///< metres in its first channel, 0 = unknown, negative = inpainted
    const IndirectTriangles& triangles;
    Eigen::Matrix3d K;  ///< of the depth map
    Pose world_from_camera;
    QuadGrid grid = QuadGrid::fine;
    float spread = 0;                         ///< depth_spread() of the camera
    const IndirectTriangles* rims = nullptr;  ///< drawn with the triangles if not null
    double rim_px = 0;  ///< reach of the rims from the middles of their pixels
};

}  // namespace vantage
