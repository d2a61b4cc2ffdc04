#pragma once

#include <cstdint>
#include <vector>

#include "common/board/board_pattern.h"
#include "common/geometry/camera_model.h"
#include "common/geometry/pose.h"
#include "common/image/image.h"

namespace vantage {

/// Imperfections of a camera image.
struct PictureFaults {
    double blur_px = 0.6;      ///< Gaussian sigma of the lens, in addition to the pixel's area
    double noise_sigma = 2.0;  ///< grey levels
    double light_slope = 0.2;  ///< relative fall-off of the light across the image
    double glare = 0;          ///< width of an overexposed spot relative to the board; 0: none
};

/// A camera that films calibration boards. Each pixel is the mean of samples on a subpixel grid,
/// which are traced through the lens to the boards' planes. So the image follows the model itself
/// and shares no code with corner detection.
class BoardCamera {
  public:
    /// Precomputes the pinhole lens's rays. Squares of the boards are 40 texels wide.
    BoardCamera(const std::vector<BoardPattern>& patterns, const CameraModel& camera);

    /// Renders the first board. Corners outside the image or behind the camera are missing.
    GreyImage film(const Pose& camera_from_board, const PictureFaults& faults,
                   std::uint64_t seed) const;

    /// A board's index and its pose camera_from_board.
    struct PlacedBoard {
        std::size_t board = 0;
        Pose camera_from_board = Pose::Identity();
    };
    /// Renders several boards with occlusion; the back of a board is grey. Glare affects the first.
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
