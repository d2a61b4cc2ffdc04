#pragma once

#include "common/geometry/pose.h"
#include "common/gl/objects/buffer.h"
#include "common/gl/objects/texture.h"

namespace vantage {

/// How many pixels of a depth map a quad of its grid spans; where a coarse one is cut, its parts
/// span one each.
enum class QuadGrid { fine = 1, coarse = 2 };

/// Indices of two triangles a pixel of a depth map of this size.
int triangle_indices(cv::Size depth_size);

/// Triangles of a depth map, as an indirect draw: how many they are is known to the GPU alone.
struct IndirectTriangles {
    Buffer indices, command;
    int capacity;  ///< indices

    explicit IndirectTriangles(int most_indices);
    /// None from now on, until a shader writes some. Binds the indices to storage 0 and the command
    /// to storage 1.
    void begin() const;
    /// With the program and vertices in use.
    void draw() const;
};

/// A depth map of a camera, as a grid of quads.
struct DepthGrid {
    const Texture& depth_m;  ///< metres in its first channel, 0 = unknown, negative = guessed
    const IndirectTriangles& triangles;
    Eigen::Matrix3d K;  ///< of the depth map
    Pose world_from_camera;
    QuadGrid grid = QuadGrid::fine;
    float spread = 0;  ///< relative uncertainty of the depth, per metre of it
    const IndirectTriangles* rims = nullptr;  ///< drawn too where there are any
    double rim_px = 0;  ///< how far they reach from the middles of their pixels
};

}  // namespace vantage
