#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/pose.h"

namespace vantage {

// Drawings in SVG, each a complete <svg> element.

/// A miss at a place of a picture, px.
struct PictureVector {
    Eigen::Vector2d at_px, miss_px;
};

/// Misses drawn where they are in the picture, all enlarged by one round factor so that the usual
/// one can be seen; the factor is written beside.
std::string draw_vectors(int width_px, int height_px, const std::vector<PictureVector>& vectors);

/// How many corners fell into each cell of a picture, row by row.
std::string draw_coverage(int width_px, int height_px, int columns, int rows,
                          const std::vector<int>& counts);

struct Bar {
    std::string name;
    double value = 0;
};
/// One bar a name, from the bottom; a dashed line at `usual`, if it is above 0.
std::string draw_bars(const std::vector<Bar>& bars, const std::string& unit, double usual);

struct PlacedRig {
    std::string name;
    Pose world_from_camera = Pose::Identity();
    double field_of_view_rad = 0;
    double sigma_m = 0;
};
struct RigTie {
    std::size_t a = 0, b = 0;
    std::string label;
    bool weak = false;
};
/// The stage from above (the plane of the two longest extents where the world has no floor): rigs
/// with their fields of view, ties between them, circles of uncertainty a hundred times enlarged.
std::string draw_stage(const std::vector<PlacedRig>& rigs, const std::vector<RigTie>& ties,
                       bool y_is_up);

/// Values of one measure over time, oldest first, with its limits.
std::string draw_history(const std::vector<double>& values, double warn_at, double bad_at,
                         const std::string& unit);

}  // namespace vantage
