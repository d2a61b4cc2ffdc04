#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "host_app/baked/depth_planes.h"

namespace vantage {

/// Triangles over some pixels of a depth map: vertices are (u * z, v * z, z).
struct PartMesh {
    std::vector<Eigen::Vector3f> vertices;
    std::vector<std::uint32_t> indices;
};

/// Makes a mesh of the selected pixels: each is a square whose corners it shares with the
/// neighbours on the same surface, so that a surface ends half a pixel beyond the middles of its
/// last pixels, and things of one pixel's width are kept. Outlines are smoothed by less than half a
/// pixel. The mesh is decimated where that moves it by less than a third of a pixel in parallax.
///
/// @param parallax_px how many pixels a place moves in another rig's picture for each 1/m of
///     inverse depth
PartMesh part_mesh(const DepthPlanes& planes, const cv::Mat1b& selected, double parallax_px);

}  // namespace vantage
