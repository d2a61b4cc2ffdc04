#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "common/geometry/pose.h"
#include "common/image/image.h"

namespace vantage {

/// Writes a view set folder: images and maps first, views.json last, so that a folder with a
/// views.json is complete. Not thread-safe.
class ViewSetWriter {
  public:
    /// Creates the folder. Throws Error if that fails, or if it contains a view set.
    explicit ViewSetWriter(std::filesystem::path folder);

    struct Camera {
        std::string name;
        Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
        Pose world_from_camera = Pose::Identity();
    };
    /// Begins a view with a copy of its image; maps are added to the last view. Throws Error, as
    /// add_disparity() does, for a file that cannot be read, before it is copied.
    void begin_view(const Camera& camera, const std::filesystem::path& picture);
    struct Disparity {
        std::filesystem::path file;  ///< to be copied
        std::optional<double> scale, unknown;
        double baseline_m = 0, doffs_px = 0;
    };
    void add_disparity(const Disparity& disparity);
    void add_depth(const DepthImage& depth_m);

    /// Writes views.json. Throws Error if that fails.
    void finish();
    int views() const { return static_cast<int>(document_["views"].size()); }
    int with_geometry() const { return with_geometry_; }

  private:
    std::string copy(const std::filesystem::path& file, const std::string& stem);

    std::filesystem::path folder_;
    cv::Size picture_size_;  ///< of the view that was begun last
    nlohmann::ordered_json document_{{"version", 1}, {"views", nlohmann::ordered_json::array()}};
    int with_geometry_ = 0;
};

}  // namespace vantage
