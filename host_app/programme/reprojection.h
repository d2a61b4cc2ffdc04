#pragma once

#include <optional>

#include "common/image/image.h"
#include "host_app/flight/camera_state.h"

namespace vantage {

/// Carries a picture on to where the camera went since it was rendered: every pixel is looked up
/// where its surface was seen, which a few fixed-point steps over the picture's depth find (Bowles
/// et al., Iterative Image Warping, 2012). What the first camera did not see is stretched over: for
/// the way of a few ticks.
class Reprojection {
  public:
    /// Of the picture's width, that surfaces may have gone: further away stretched edges show.
    static constexpr double furthest = 0.15;

    /// `inverse_depth` in 1/m, of the first camera's picture, on a grid of any number of cells.
    /// Nothing if the way between the cameras is too long for that, or there is no depth.
    static std::optional<Reprojection> between(const CameraState& from, const CameraState& to,
                                               const cv::Mat1f& inverse_depth, cv::Size size);

    /// About how far surfaces go between two cameras, as a share of the picture's width.
    static double way(const CameraState& from, const CameraState& to);

    /// The picture is of the first camera; one of another size is resampled to this first.
    /// `carried`: memory for the second camera's, where that has the size.
    ColourImage apply(const ColourImage& picture, ColourImage carried = {}) const;

  private:
    Reprojection(cv::Mat2f offsets, cv::Size size) : offsets_(std::move(offsets)), size_(size) {}

    cv::Mat2f offsets_;  ///< of the grid: how far a pixel of the second camera is from its place in
                         ///< the first one's picture, in px of a picture of `size_`
    cv::Size size_;
};

}  // namespace vantage
