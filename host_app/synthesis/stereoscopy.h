#pragma once

#include <optional>
#include <span>

#include <nlohmann/json.hpp>

#include "host_app/instants/depth_view.h"
#include "host_app/instants/drawn_texture.h"
#include "host_app/synthesis/synthesiser.h"

namespace vantage {

/// How the two eyes of a stereoscopic picture stand to each other.
struct Stereoscopy {
    /// Between the eyes. 0: so that what is infinitely far lies 2 % of the picture's width apart,
    /// which eyes still fuse with ease, whatever the distance and the field of view.
    double interaxial_m = 0;
    /// Distance of what appears at the screen's depth. 0: that of the camera's pivot.
    double convergence_m = 0;

    /// With the defaults put in: `focus_m` is the distance of what the camera looks at. Throws
    /// Error if a side by side picture of this width cannot be.
    Stereoscopy settled(const VirtualView& view, double focus_m) const;
};

nlohmann::ordered_json to_json(const Stereoscopy& settled);

/// The cameras of the two eyes, each of half the view's width: two parallel cameras beside the
/// view's own, their pictures shifted so that what is at the convergence distance is at the same
/// place in both; turning them inward instead would bend the picture (keystone).
/// Preconditions: `settled`, and the view's width is even.
struct EyeViews {
    VirtualView left, right;
};
EyeViews eye_views(const VirtualView& view, const Stereoscopy& settled);

/// The median depth of what the views show in a virtual view; 0: they show nothing of it.
double typical_depth_m(std::span<const DepthView> views, const VirtualView& target);

/// Puts the eyes' pictures beside each other, left eye on the left: a frame-compatible
/// ("half") picture that 3D displays take as any other.
class SideBySide {
  public:
    /// Of the next picture. Keeps what there is if the size stays.
    void resize(cv::Size size) { picture_.resize(size); }
    /// Copies an eye's picture, rgba8 of half the width, to its half.
    void put_left(const Texture& eye) const { put(eye, 0); }
    void put_right(const Texture& eye) const { put(eye, eye.width_px()); }
    const Texture& picture() const { return picture_.texture(); }

  private:
    void put(const Texture& eye, int x_px) const;

    DrawnTexture picture_{TextureFormat::rgba8, Filter::linear};
};

}  // namespace vantage
