#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/geometry/camera_model.h"
#include "common/geometry/pose.h"

namespace vantage {

/// A calibrated single camera of a stage: an entry [[cameras]] of stage.toml. It is no rig, and
/// `vantage live` receives none; pairs of such cameras become rigs.
struct SingleCamera {
    std::string name;
    CameraModel model;
    Pose world_from_camera = Pose::Identity();
    /// A picture, numbered pictures, a video, a device of V4L2, or the name of a libcamera camera;
    /// empty if it is not known yet. Paths of files are absolute or relative to the working folder.
    std::string source;
    std::filesystem::path outline;  ///< white where the foreground is in the picture; empty: none
};

/// Loads the entries [[cameras]] of a stage file, which may hold rigs too. Throws Error with file
/// and line for an invalid entry, and if there is none.
std::vector<SingleCamera> load_stage_cameras(const std::filesystem::path& stage);

/// The text of an entry with this calibration file, both relative to the stage file's folder.
std::string stage_camera_text(const SingleCamera& camera, const std::string& calibration_file);

}  // namespace vantage
