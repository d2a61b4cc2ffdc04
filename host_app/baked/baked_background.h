#pragma once

#include <memory>
#include <vector>

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/texture.h"
#include "host_app/surfaces/instant.h"
#include "host_app/views/virtual_view.h"

namespace vantage {

/// One view of the background with its depth, as planar tiles that other views are drawn from.
/// Immutable once made.
class BackgroundProbe {
  public:
    /// Makes the tiles of a picture of `view`: rgba8 colours, whose alpha is below 128 where the
    /// place was never seen, and depth in metres, 0 = none. `parallax_px_m` is the parallax that an
    /// inverse depth of 1/m has in the views that the probe is for, px m.
    BackgroundProbe(const VirtualView& view, const ColourImage& colour, const DepthImage& depth_m,
                    double parallax_px_m);

    /// A range of the vertices and the pictures that it is drawn with.
    struct Part {
        std::size_t first_tile = 0, tiles = 0;
        Texture colour;         ///< rgba8
        Texture inverse_depth;  ///< r32f, 1/m, 0 = none
        float cell_px = 1;      ///< pixels of the view that a pixel of `colour` spans
        bool is_guessed = false;
    };

    const VirtualView& view() const { return view_; }
    const Buffer& vertices() const { return *vertices_; }
    const Buffer& indices() const { return *indices_; }
    const std::vector<Part>& parts() const { return parts_; }

  private:
    VirtualView view_;
    std::vector<Part> parts_;
    std::optional<Buffer> vertices_, indices_;
};

/// What the background looks like from a few places, made once per change of the background.
struct BakedBackground {
    std::vector<std::shared_ptr<const BackgroundProbe>> probes;
};

/// Returns the cameras of the probes for rigs at these places: one at each rig and one midway
/// between any two that are neighbours. They see a little more than the rigs do.
std::vector<VirtualView> probe_views(std::span<const DepthView* const> rigs);

/// Returns the parallax that an inverse depth of 1/m has between a probe and a view halfway to the
/// next one, px m.
double largest_parallax_px_m(std::span<const VirtualView> probes);

/// Hands a baked background from the preparer to the renderer.
struct BakedExtra final : InstantExtra {
    std::shared_ptr<const BakedBackground> background;
};

}  // namespace vantage
