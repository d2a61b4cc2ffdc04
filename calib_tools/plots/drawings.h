#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/pose.h"

namespace vantage {

// Drawings in SVG; each function returns a complete <svg> element.

/// Error vector at a position of an image, in pixels.
struct PictureVector {
    Eigen::Vector2d at_px, miss_px;
};

/// Draws error vectors at their positions, enlarged by one round factor that makes a typical vector
/// visible; the factor is printed.
std::string draw_vectors(int width_px, int height_px, const std::vector<PictureVector>& vectors);

/// Draws the number of corners in each cell of an image, row by row.
std::string draw_coverage(int width_px, int height_px, int columns, int rows,
                          const std::vector<int>& counts);

struct Bar {
    std::string name;
    double value = 0;
};
/// Draws one bar per name, from the bottom up, with a dashed line at `usual` if it is above 0.
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
/// Draws the stage from above (the plane of the two longest extents if the world has no floor):
/// rigs with their fields of view, connections between them, and circles of uncertainty enlarged a
/// hundred times.
std::string draw_stage(const std::vector<PlacedRig>& rigs, const std::vector<RigTie>& ties,
                       bool y_is_up);

/// Draws the values of one measure over time, oldest first, with its limits.
std::string draw_history(const std::vector<double>& values, double warn_at, double bad_at,
                         const std::string& unit);

}  // namespace vantage
