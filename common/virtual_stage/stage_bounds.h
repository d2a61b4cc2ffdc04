#pragma once

#include <span>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "common/virtual_stage/virtual_stage.h"

namespace vantage {

/// Which rectangle of its picture a camera sees things in.
class ScreenBounds {
  public:
    explicit ScreenBounds(const StageCamera& camera);

    /// Holds the pixels that show anything of what is between the points; the whole picture where
    /// one is nearer than 10 cm or behind the camera.
    cv::Rect of(std::span<const Eigen::Vector3f> points_m) const;

  private:
    Eigen::Matrix3f K_;
    Eigen::Affine3f camera_from_world_;
    cv::Rect picture_;
};

/// Parts of a picture, in squares, so that none is held twice.
class PictureParts {
  public:
    explicit PictureParts(cv::Size picture);

    void add(const cv::Rect& part);
    void add(const PictureParts& parts) { squares_ |= parts.squares_; }
    bool holds_any_of(const cv::Rect& part) const;
    /// As rectangles that do not overlap.
    std::vector<cv::Rect> rectangles() const;

  private:
    cv::Rect squares_of(const cv::Rect& part) const;

    cv::Rect picture_;
    cv::Mat1b squares_;  ///< 255: held
};

}  // namespace vantage
