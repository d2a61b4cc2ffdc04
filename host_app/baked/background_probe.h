#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/texture.h"
#include "host_app/baked/depth_tiles.h"
#include "host_app/surfaces/instant.h"
#include "host_app/views/virtual_view.h"

namespace vantage {

/// One view of the background as planar tiles in main memory. Made without a GPU, on any thread.
struct ProbeTiles {
    VirtualView view;
    std::vector<DepthTile> tiles;  ///< of the surfaces, then of the backdrop behind them
    std::size_t surface_tiles = 0;
    DepthImage inverse_depth;  ///< 1/m, 0 = none
    ColourImage colour;        ///< rgba8, alpha below 128 where no rig sees the place
    ColourImage backdrop;      ///< the colours of the backdrop, one pixel a cell
};

/// Divides a picture of `view` into tiles. `colour` is as in ProbeTiles; `depth_m` is in metres,
/// 0 = none, negative where it is inpainted. `parallax_px_m` is the parallax that an inverse depth
/// of 1/m has in the views that will be drawn from the probe, px m.
ProbeTiles probe_tiles(const VirtualView& view, const ColourImage& colour,
                       const DepthImage& depth_m, double parallax_px_m);

/// One view of the background on the GPU, which other views are drawn from. Immutable.
class BackgroundProbe {
  public:
    explicit BackgroundProbe(const ProbeTiles& tiles);

    /// A range of the tiles and the pictures that it is drawn with.
    struct Part {
        std::size_t first_tile = 0, tiles = 0;
        Texture colour;         ///< rgba8
        Texture inverse_depth;  ///< r32f, 1/m, 0 = none
        float cell_px = 1;      ///< pixels of the view that a pixel of `colour` spans
        bool is_guessed = false;
    };

    const VirtualView& view() const { return view_; }
    const Buffer& vertices() const { return vertices_; }
    const Buffer& indices() const { return indices_; }
    const Part& surfaces() const { return surfaces_; }
    /// A coarse surface behind all others, for places that no probe sees.
    const Part& backdrop() const { return backdrop_; }

  private:
    VirtualView view_;
    Part surfaces_, backdrop_;
    Buffer vertices_, indices_;
};

/// What the background looks like from a few places, made once per change of the background.
struct BakedBackground {
    std::vector<std::shared_ptr<const BackgroundProbe>> probes;
};

/// Hands a baked background from the preparer to the renderer.
struct BakedExtra final : InstantExtra {
    BakedBackground background;
};

}  // namespace vantage
