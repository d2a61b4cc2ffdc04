#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/geometry/pose.h"
#include "common/image/image.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/views/depth_view.h"

namespace vantage {

/// Images of one instant from calibrated cameras, some with depth: a folder with a views.json in
/// this form:
///
///   {"version": 1, "views": [{
///     "name": "left",                 unique
///     "image": "left.png",            8-bit colour, path relative to the folder
///     "K": [[fx,s,cx],[0,fy,cy],[0,0,1]],               of the picture, px
///     "world_from_camera": [[..4],[..4],[..4]],         rigid, metres
///     "disparity": "left.pfm"         or "depth": "left.png"; neither: no geometry
///     "outline": "left_outline.png",  white where the foreground is; optional
///     "scale": 0.25,                  file value * scale = px of the image, or metres; optional
///                                     for PFM
///     "unknown": 0,                   file value for unknown; PFM: not finite is unknown
///     "baseline_m": 0.1,              with disparity
///     "doffs_px": 52                  with disparity, 0 if left out: z = fx * baseline / (d +
///   }]}                               doffs)
///
/// A disparity or depth map of another size than its image has the same field of view.
struct ViewSet {
    std::vector<DepthView> views;
    std::vector<GreyImage> outlines;  ///< of each view, in its picture's size; empty: none

    /// Throws Error with the known names.
    std::size_t index_of(std::string_view name) const;
};

/// Throws Error naming the file, the view and the key for missing or invalid values. Unknown keys
/// are logged and ignored.
ViewSet load_view_set(const std::filesystem::path& folder);

/// Reads an outline: above 127 where the foreground is. Throws Error, with the view's name, if it
/// is of another size.
GreyImage read_outline(const std::filesystem::path& file, const std::string& view, cv::Size size);

/// Loads a camera for `vantage render --pose`: JSON or TOML (by extension) with the keys width,
/// height, K and world_from_camera in the form of views.json. Throws Error likewise.
VirtualView load_virtual_view(const std::filesystem::path& file);

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

/// The single cameras [[cameras]] of a stage file as a view set, without the distortion of their
/// lenses: their pictures, or the first pictures of their videos, and their outlines. Throws Error
/// naming the camera for what is missing or of another size.
ViewSet load_stage_views(const std::filesystem::path& stage);

/// The result of importing a published data set.
struct ImportedViews {
    int views = 0, with_geometry = 0;
};

/// Imports one instant of a Microsoft Research 3-D video sequence (Zitnick et al., 2004) as a
/// ViewSet. `folder` contains calibParams-*.txt and camN/color-camN-fTTT.jpg with
/// camN/depth-camN-fTTT.png. The data set counts image rows from the bottom and measures all depth
/// along the axis of one camera; both are converted, the former by inverting the world's y axis.
/// Lengths keep the data's unit. `depth_range` is (MinZ, MaxZ); those of "ballet" and
/// "breakdancers" are known by the name of the parameter file. `instant` is TTT; by default the
/// first one with a depth map. Throws Error naming the file for missing or malformed data, and if
/// no camera of the instant has a depth map.
ImportedViews import_msr3dvideo(const std::filesystem::path& folder,
                                const std::filesystem::path& view_set, std::optional<int> instant,
                                std::optional<std::pair<double, double>> depth_range);

/// Imports a Middlebury stereo scene as a ViewSet. The kind follows from the folder's files:
/// calib.txt (third evaluation and 2014), view0 .. view6 (2005 and 2006), im0 .. im8 with disp2 and
/// disp6 (2001 and 2003), im3 and im4 with disp3 (Tsukuba). Where no camera was published, a
/// nominal one is used: views between and beside the given ones do not depend on it. Throws Error
/// likewise.
ImportedViews import_middlebury(const std::filesystem::path& folder,
                                const std::filesystem::path& view_set);

}  // namespace vantage
