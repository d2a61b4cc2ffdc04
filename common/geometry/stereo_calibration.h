#pragma once

#include <string>

#include <Eigen/Core>

#include "common/geometry/camera_model.h"
#include "common/geometry/pose.h"
#include "common/geometry/rectified_stereo.h"

namespace vantage {

/// The calibration of one stereo rig: both lenses, their relative pose, and the chosen
/// rectification.
struct StereoCalibration {
    std::string
        id;  ///< identifies the calibration in every frame header: hex checksum of its content
    CameraModel left, right;
    Pose right_from_left = Pose::Identity();

    /// Rotations from each camera to the common rectified orientation, and the geometry of the
    /// rectified pair.
    Eigen::Matrix3d rectified_from_left = Eigen::Matrix3d::Identity();
    Eigen::Matrix3d rectified_from_right = Eigen::Matrix3d::Identity();
    RectifiedStereo rectified;

    /// Pose of the LEFT camera before rectification in the stage's world frame.
    Pose world_from_left = Pose::Identity();
    /// Whether the pose was assumed (assume_place), since no stage calibration contains it.
    bool place_is_assumed = false;
    /// Pose of the rectified left view, which the published frames show.
    Pose world_from_rectified_left() const;

    /// Throws Error naming the first invalid value.
    void validate() const;
};

/// Computes Bouguet's rectification (cv::stereoRectify, cv::fisheye::stereoRectify) with zero
/// disparity at infinity, and fills the rectified fields. alpha: 0 keeps only valid pixels, 1 keeps
/// all source pixels.
void compute_rectification(StereoCalibration& calibration, double alpha);

/// The assumed height of a rig without a stage calibration: a person's eye level.
inline constexpr double assumed_height_m = 1.6;

/// Assumes a pose for a rig that no stage calibration contains, and sets place_is_assumed: level,
/// the middle between its rectified cameras assumed_height_m above the origin of a y-up world,
/// looking along -z like a rig at azimuth 0 of the virtual stage. The rectification is unchanged.
void assume_place(StereoCalibration& calibration);

/// The calibration of an already rectified pair: no distortion, no rotation.
StereoCalibration rectified_calibration(const RectifiedStereo& geometry);

}  // namespace vantage
