#pragma once

#include <span>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "common/virtual_stage/virtual_stage.h"

namespace vantage {

/// Projects points of the scene to bounding rectangles in a camera's image.
class ScreenBounds {
  public:
    explicit ScreenBounds(const StageCamera& camera);

    /// The rectangle of all pixels that show anything of the points' convex hull; the whole image
    /// if a point is nearer than 10 cm or behind the camera.
    cv::Rect of(std::span<const Eigen::Vector3f> points_m) const;

  private:
    Eigen::Matrix3f K_;
    Eigen::Affine3f camera_from_world_;
    cv::Rect picture_;
};

/// A region of an image, in squares, without overlap.
class PictureParts {
  public:
    explicit PictureParts(cv::Size picture);

    void add(const cv::Rect& part);
    void add(const PictureParts& parts) { squares_ |= parts.squares_; }
    bool holds_any_of(const cv::Rect& part) const;
    /// The region as rectangles that do not overlap.
    std::vector<cv::Rect> rectangles() const;

  private:
    cv::Rect squares_of(const cv::Rect& part) const;

    cv::Rect picture_;
    cv::Mat1b squares_;  ///< 255: in the region
};

}  // namespace vantage
