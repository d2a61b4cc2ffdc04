#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <opencv2/core/types.hpp>

#include "common/geometry/pose.h"
#include "host_app/flight/camera_state.h"
#include "host_app/flight/moves/move.h"

namespace vantage {

/// A camera's way as other programs have it: a camera a picture, evenly in time.
struct CameraPath {
    double rate_hz = 25;
    cv::Size size_px{1920, 1080};  ///< of the pictures; its shape is the lens's
    std::vector<CameraState> cameras;
};

/// Settings that a camera file may lack.
struct CameraPathSettings {
    /// Rate of its cameras, or at which an animation is sampled; empty: the file's, else 25 Hz.
    std::optional<double> rate_hz = {};
    cv::Size size_px{1920, 1080};                  ///< where the file says none
    double focus_m = 4.5;                          ///< where the file says none
    std::optional<double> field_of_view_rad = {};  ///< instead of what the file says
};

constexpr double default_camera_rate_hz = 25;

/// Most cameras that a file may have: ten minutes at 60 a second, and some.
constexpr std::size_t most_cameras = 40'000;

/// From the move's start to its end. Throws Error where that are more than most_cameras.
CameraPath sampled(const Move& move, double rate_hz, cv::Size size_px);

/// A move on a free path, as near to the cameras as the tolerance says (see simplified()).
/// Precondition: there is a camera.
SimplifiedFlight move_along(const CameraPath& path, const FlightTolerance& tolerance);

/// A form in which other programs have a camera's way, known by the name of its file.
struct CameraPathForm {
    std::string name;   ///< "freed"
    std::string words;  ///< for people
    bool (*is_named_so)(const std::filesystem::path& file);
    /// Throws Error with the file and what is wrong.
    CameraPath (*read)(const std::filesystem::path& file, const CameraPathSettings& settings);
    /// Throws Error if the disk fails. What is there is replaced; but a cameras.txt of COLMAP's is
    /// refused.
    void (*write)(const CameraPath& path, const std::filesystem::path& file);
};
std::vector<CameraPathForm> camera_path_forms();
/// Throws Error that lists the names there are.
CameraPathForm form_of(const std::filesystem::path& file);

/// Throws Error, naming the file, if it has no camera or more than most_cameras.
void require_cameras(std::size_t count, const std::filesystem::path& file);
/// Throws Error, naming the file, for a lens that Vantage has not.
double checked_field_of_view(double angle_rad, const std::filesystem::path& file);

/// FreeD D1 messages of 29 bytes, one after the other (`vantage take export --as camera`).
CameraPathForm freed_form();
/// COLMAP's text model: images.txt, with cameras.txt beside it.
CameraPathForm colmap_form();
/// The cameras of an MPEG view set (TMIV, RVS) as JSON, axes of OMAF.
CameraPathForm omaf_form();
/// glTF 2.0: a perspective camera and the animation of its node.
CameraPathForm gltf_form();

// Of bytes in memory; `file` is what is named in what is refused.
CameraPath freed_path_of(std::span<const std::byte> bytes, const std::filesystem::path& file,
                         const CameraPathSettings& settings);
CameraPath colmap_path_of(const std::string& images, const std::string& cameras,
                          const std::filesystem::path& file, const CameraPathSettings& settings);
CameraPath omaf_path_of(const std::string& text, const std::filesystem::path& file,
                        const CameraPathSettings& settings);
CameraPath gltf_path_of(std::span<const std::byte> bytes, const std::filesystem::path& file,
                        const CameraPathSettings& settings);

/// A camera as the cameras of an MPEG view set (TMIV, RVS) are told: axes of OMAF, the picture's
/// corner at 0, 0.
nlohmann::ordered_json omaf_camera(const std::string& name, const Pose& world_from_camera,
                                   const Eigen::Matrix3d& K, cv::Size size_px);

}  // namespace vantage
