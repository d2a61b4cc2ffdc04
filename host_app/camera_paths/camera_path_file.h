#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "host_app/camera_paths/camera_path.h"

namespace vantage {

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

/// What a file without a camera, or with too many, is refused with.
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

}  // namespace vantage
