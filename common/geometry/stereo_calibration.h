#pragma once

#include <string>

#include <Eigen/Core>

#include "common/geometry/camera_model.h"
#include "common/geometry/pose.h"
#include "common/geometry/rectified_stereo.h"

namespace vantage {

/// What a calibration says of one stereo rig: both lenses, their relative pose, and the chosen
/// rectification.
struct StereoCalibration {
    std::string
        id;  ///< names this calibration in every frame header: hex of its content's checksum
    CameraModel left, right;
    Pose right_from_left = Pose::Identity();

    /// Rotations from each camera to the common rectified orientation, and the rectified pair's
    /// geometry.
    Eigen::Matrix3d rectified_from_left = Eigen::Matrix3d::Identity();
    Eigen::Matrix3d rectified_from_right = Eigen::Matrix3d::Identity();
    RectifiedStereo rectified;

    /// Of the LEFT camera before rectification, in the stage's world frame.
    Pose world_from_left = Pose::Identity();
    /// No stage calibration says where the rig stands: it was taken to stand level.
    bool place_is_assumed = false;
    /// Of the rectified left view, which the published pictures show.
    Pose world_from_rectified_left() const;

    /// Throws Error naming the first value that cannot be.
    void validate() const;
};

/// Bouguet's rectification (cv::stereoRectify, cv::fisheye::stereoRectify) with zero disparity at
/// infinity; alpha 0 = only valid pixels, 1 = all source pixels. Fills the rectified fields of
/// `calibration`.
void compute_rectification(StereoCalibration& calibration, double alpha);

/// How high a rig of which nobody says where it stands is taken to be: a person's eyes.
inline constexpr double assumed_height_m = 1.6;

/// Gives the rig the place of one that no stage calibration has placed: level, the middle between
/// its rectified cameras assumed_height_m above the origin of a world whose y is up, looking along
/// -z, as a rig at azimuth 0 of the virtual stage does. Sets place_is_assumed. The rectification
/// stands.
void assume_place(StereoCalibration& calibration);

/// An already rectified pair: no distortion, no rotation.
StereoCalibration rectified_calibration(const RectifiedStereo& geometry);

}  // namespace vantage
