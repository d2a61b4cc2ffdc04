#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/gl/fullscreen_pass.h"
#include "host_app/surfaces/drawn_texture.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/views/depth_view.h"

namespace vantage {

/// How the pictures of the eyes make one that a 3D display takes.
enum class StereoLayout {
    side_by_side,      ///< left eye in the left half, each at half the width
    top_and_bottom,    ///< left eye in the upper half, each at half the height
    interleaved_rows,  ///< left eye in the even rows, the first among them
    anaglyph,          ///< for red and cyan glasses, by Dubois' least squares (2001)
    quilt,             ///< many views in columns and rows for autostereoscopic displays
};
/// In the order of the enumerators: "side-by-side", ...
std::span<const std::string> stereo_layout_names();

/// How the eyes of a stereoscopic picture stand to each other.
struct Stereoscopy {
    /// From the leftmost eye to the rightmost. 0: so that what is infinitely far lies 2 % of the
    /// picture's width apart, which eyes still fuse with ease, whatever the distance and the field
    /// of view; in a quilt, which shows two neighbouring views at a time, four times that.
    double interaxial_m = 0;
    /// Distance of what appears at the screen's depth. 0: that of the camera's pivot.
    double convergence_m = 0;
    StereoLayout layout = StereoLayout::side_by_side;
    cv::Size quilt = {8, 6};  ///< columns and rows of views

    /// Columns and rows of pictures.
    cv::Size tiles() const;
    std::size_t eyes() const;
    /// Of a picture that is rendered `scale` as large as `full`: one that can be enlarged to it.
    cv::Size rendered_size(cv::Size full, double scale) const;

    /// With the defaults put in: `focus_m` is the distance of what the camera looks at. Throws
    /// Error if a picture of this size cannot be in the layout.
    Stereoscopy settled(const VirtualView& view, double focus_m) const;
};

nlohmann::ordered_json to_json(const Stereoscopy& settled);

/// The cameras of the eyes from left to right, each of its part of the view's size: parallel ones
/// beside the view's own, their pictures shifted so that what is at the convergence distance is at
/// the same place in all; turning them inward instead would bend the picture (keystone).
/// Precondition: `settled`.
std::vector<VirtualView> eye_views(const VirtualView& view, const Stereoscopy& settled);

/// The median depth of what the views show in a virtual view; 0: they show nothing of it.
double typical_depth_m(std::span<const DepthView> views, const VirtualView& target);

/// Makes one picture of the eyes' ("frame-compatible"): 3D displays take it as any other.
class EyeMosaic {
  public:
    /// The library must outlive it.
    explicit EyeMosaic(const ShaderLibrary& library) : library_(&library) {}

    /// Begins a picture of this size. Keeps what there is if the size stays.
    void begin(cv::Size size, const Stereoscopy& settled);
    /// Takes the picture of an eye, rgba8 of the size of its eye_views(); they are counted from
    /// the left.
    void put(const Texture& eye, std::size_t number);
    /// Once all eyes are there. Valid until the next begin().
    const Texture& picture();

  private:
    const ShaderLibrary* library_;
    Stereoscopy settled_;
    DrawnTexture picture_{TextureFormat::rgba8, Filter::linear};
    DrawnTexture left_{TextureFormat::rgba8}, right_{TextureFormat::rgba8};
    std::optional<FullscreenPass> rows_, anaglyph_;  ///< made when first needed
};

}  // namespace vantage
