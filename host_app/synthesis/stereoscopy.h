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

/// How the eyes' images are packed into one frame for a 3-D display.
enum class StereoLayout {
    side_by_side,      ///< left eye in the left half, each at half the width
    top_and_bottom,    ///< left eye in the upper half, each at half the height
    interleaved_rows,  ///< left eye in the even rows, the first among them
    anaglyph,          ///< for red and cyan glasses, by Dubois' least squares (2001)
    quilt,             ///< many views in columns and rows for autostereoscopic displays
};
/// In the order of the enumerators: "side-by-side", ...
std::span<const std::string> stereo_layout_names();

/// Geometry and packing of a stereoscopic picture.
struct Stereoscopy {
    /// Distance between the outermost eyes. 0: chosen so that infinitely far points lie 2 % of the
    /// picture's width apart, which eyes fuse with ease at any distance and field of view; four
    /// times that in a quilt, which shows two neighbouring views at a time.
    double interaxial_m = 0;
    /// Distance of the points that appear at the screen. 0: that of the camera's pivot.
    double convergence_m = 0;
    StereoLayout layout = StereoLayout::side_by_side;
    cv::Size quilt = {8, 6};  ///< columns and rows of views

    /// Columns and rows of images in the frame.
    cv::Size tiles() const;
    std::size_t eyes() const;
    /// Returns the size of a frame rendered at `scale` times `full` that can be enlarged to it.
    cv::Size rendered_size(cv::Size full, double scale) const;

    /// Returns a copy with the defaults filled in; `focus_m` is the distance that the camera looks
    /// at. Throws Error if a picture of this size does not fit the layout.
    Stereoscopy settled(const VirtualView& view, double focus_m) const;
};

nlohmann::ordered_json to_json(const Stereoscopy& settled);

/// Returns the eyes' cameras from left to right, each with its part of the view's size. The cameras
/// are parallel, and their images are shifted so that points at the convergence distance coincide;
/// turning the cameras inward instead would distort the images (keystone). Precondition: `settled`
/// comes from Stereoscopy::settled().
std::vector<VirtualView> eye_views(const VirtualView& view, const Stereoscopy& settled);

/// Returns the median depth of the views' surfaces in a virtual view, metres; 0: they show none.
double typical_depth_m(std::span<const DepthView> views, const VirtualView& target);

/// Packs the eyes' images into one frame ("frame-compatible" 3-D). Belongs to one context.
class EyeMosaic {
  public:
    /// The library must outlive it.
    explicit EyeMosaic(const ShaderLibrary& library) : library_(&library) {}

    /// Begins a frame of this size. Its textures are reused if the size stays the same.
    void begin(cv::Size size, const Stereoscopy& settled);
    /// Takes an eye's image, rgba8 in the size of its eye_views(). Eyes are counted from the left.
    void put(const Texture& eye, std::size_t number);
    /// Returns the frame, valid until the next begin(). Precondition: put() was called for all
    /// eyes.
    const Texture& picture();

  private:
    const ShaderLibrary* library_;
    Stereoscopy settled_;
    DrawnTexture picture_{TextureFormat::rgba8, Filter::linear};
    DrawnTexture left_{TextureFormat::rgba8}, right_{TextureFormat::rgba8};
    std::optional<FullscreenPass> rows_, anaglyph_;  ///< made when first needed
};

}  // namespace vantage
