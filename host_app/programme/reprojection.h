#pragma once

#include <optional>

#include "common/image/image.h"
#include "host_app/flight/camera_state.h"

namespace vantage {

/// Reprojects a frame to a camera that has moved since it was rendered. Every pixel is looked up at
/// the place where the first camera saw its surface, which fixed-point steps over the depth compute
/// (Bowles et al., Iterative Image Warping, 2012). Surfaces that the first camera did not see are
/// stretched over, so this suits the way of a few ticks.
class Reprojection {
  public:
    /// Largest shift of a surface, as a share of the picture's width; beyond it stretched edges
    /// become visible.
    static constexpr double max_way = 0.15;

    /// Prepares a reprojection. `inverse_depth` is that of the first camera's frame, in 1/m, on a
    /// grid of any size. Empty if the shift is too large or there is no depth.
    static std::optional<Reprojection> between(const CameraState& from, const CameraState& to,
                                               const cv::Mat1f& inverse_depth, cv::Size size);

    /// Estimated shift of surfaces between two cameras, as a share of the picture's width.
    static double way(const CameraState& from, const CameraState& to);

    /// Reprojects the first camera's frame, which is resampled first if it has another size. The
    /// result uses the memory of `carried` if its size fits.
    ColourImage apply(const ColourImage& picture, ColourImage carried = {}) const;

  private:
    Reprojection(cv::Mat2f offsets, cv::Size size) : offsets_(std::move(offsets)), size_(size) {}

    cv::Mat2f offsets_;  ///< from a pixel of the second camera to its place in the first one's
                         ///< frame, on the grid, in px of a frame of `size_`
    cv::Size size_;
};

}  // namespace vantage
