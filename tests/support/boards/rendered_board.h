#pragma once

#include <cstdint>
#include <vector>

#include "calib_tools/board/board_pattern.h"
#include "common/geometry/camera_model.h"
#include "common/geometry/pose.h"
#include "common/image/image.h"

namespace vantage {

/// What keeps a picture from being ideal.
struct PictureFaults {
    double blur_px = 0.6;      ///< Gaussian sigma of the lens, on top of the pixel's own square
    double noise_sigma = 2.0;  ///< grey levels
    double light_slope = 0.2;  ///< share by which the light falls off across the picture
    double glare = 0;          ///< share of the board's width under a burnt-out spot; 0: none
};

/// A camera that films boards. Every pixel is the mean of samples on a grid finer than it, each of
/// them traced through the lens to the boards' planes, so the picture is that of the model itself
/// and owes nothing to any code that looks for corners.
class BoardCamera {
  public:
    /// Works out the lens, a pinhole one, once. A board's squares are drawn 40 texels wide.
    BoardCamera(const std::vector<BoardPattern>& patterns, const CameraModel& camera);

    /// What it sees of the first board. Corners outside the picture or behind the camera are simply
    /// not there.
    GreyImage film(const Pose& camera_from_board, const PictureFaults& faults,
                   std::uint64_t seed) const;

    /// A board where it stands: which one, and camera_from_board.
    struct PlacedBoard {
        std::size_t board = 0;
        Pose camera_from_board = Pose::Identity();
    };
    /// The nearest board hides what is behind it; from behind a board is grey. Glare is on the
    /// first.
    GreyImage film(const std::vector<PlacedBoard>& boards, const PictureFaults& faults,
                   std::uint64_t seed) const;

    const CameraModel& model() const { return camera_; }

  private:
    cv::Rect extent(const PlacedBoard& placed) const;

    std::vector<BoardPattern> patterns_;
    CameraModel camera_;
    std::vector<GreyImage> pictures_;     ///< of the boards, with their margins
    cv::Mat2d rays_, rays_dx_, rays_dy_;  ///< slopes x/z, y/z at pixel centres; change per pixel
};

}  // namespace vantage
