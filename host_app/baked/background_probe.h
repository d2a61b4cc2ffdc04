#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/texture.h"
#include "common/image/image.h"
#include "host_app/baked/probe_surface.h"
#include "host_app/surfaces/instant.h"
#include "host_app/views/depth_view.h"

namespace vantage {

/// A corner of a tile: a place in a depth map (px, pixel centres at whole numbers), the inverse
/// depth of the tile's plane there (1/m), and how far an inverse depth of the map may lie from the
/// plane and still belong to the tile (1/m).
struct TileCorner {
    float u_px, v_px, inverse_depth, tolerance;
};

/// A quad of a depth map whose pixels lie on one plane: inverse depth is linear over a plane's
/// picture.
struct DepthTile {
    TileCorner corners[4];  ///< top left, top right, bottom left, bottom right
};

/// Divides a depth map (metres, 0 = none) into planar tiles. A block of 16 px that holds more than
/// two surfaces, or one that bends by more than `tolerance` (1/m), is divided into four, down to
/// 2 px. Each surface of a block gets a tile of its own, one pixel larger than the surface in every
/// direction, so that neighbours overlap; a renderer keeps of it what is near enough to the map's
/// own depth.
std::vector<DepthTile> planar_tiles(const DepthImage& depth_m, float tolerance);

/// A coarse surface without holes behind all surfaces of a depth map: connected quads of
/// `cell_px`, at the farther depth where a cell has several, and continued from around where it has
/// none. Empty if the map has no depth at all.
std::vector<DepthTile> backdrop_tiles(const DepthImage& depth_m, int cell_px);

/// Alpha of colours for places that no rig has seen; those of seen places have more than 127.
inline constexpr std::uint8_t never_seen_alpha = 64;

/// The colours of backdrop_tiles(): for each cell the mean of its farther pixels (rgba8, alpha
/// never_seen_alpha), continued where a cell has none.
ColourImage backdrop_colours(const ColourImage& colour, const DepthImage& depth_m, int cell_px);

/// One view of the background as planar tiles in main memory. Made without a GPU, on any thread.
struct ProbeTiles {
    VirtualView view;
    std::vector<DepthTile> tiles;  ///< of the surfaces, then of the backdrop behind them
    std::size_t surface_tiles = 0;
    DepthImage inverse_depth;  ///< 1/m, 0 = none
    ColourImage colour;        ///< rgba8, alpha below 128 where no rig sees the place
    cv::Mat4b visibility;      ///< how well each of `rigs` sees the place
    std::vector<std::string> rigs;
    ColourImage backdrop;  ///< the colours of the backdrop, one pixel a cell
};

/// Divides a surface, as `view` sees it, into tiles. `parallax_px_m` is the parallax that an
/// inverse depth of 1/m has in the views that will be drawn from the probe, px m.
ProbeTiles probe_tiles(const VirtualView& view, const ProbeSurface& surface, double parallax_px_m);

/// One view of the background on the GPU, which other views are drawn from. Immutable.
class BackgroundProbe {
  public:
    explicit BackgroundProbe(const ProbeTiles& tiles);

    /// A range of the tiles and the pictures that it is drawn with.
    struct Part {
        std::size_t first_tile = 0, tiles = 0;
        Texture colour;         ///< rgba8
        Texture inverse_depth;  ///< r32f, 1/m, 0 = none
        Texture visibility;     ///< rgba8, how well each of rigs() sees it
        float cell_px = 1;      ///< pixels of the view that a pixel of `colour` spans
        bool is_guessed = false;
    };

    const VirtualView& view() const { return view_; }
    /// The names of the rigs of the visibility's channels, in their order.
    const std::vector<std::string>& rigs() const { return rigs_; }
    const Buffer& vertices() const { return vertices_; }
    const Buffer& indices() const { return indices_; }
    const Part& surfaces() const { return surfaces_; }
    /// A coarse surface behind all others, for places that no probe sees.
    const Part& backdrop() const { return backdrop_; }

  private:
    VirtualView view_;
    std::vector<std::string> rigs_;
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

/// Returns the cameras of the probes for rigs with these cameras and picture sizes: one at each rig
/// and one midway between any two that are neighbours. They see a little more than the rigs do.
struct ProbeRig {
    Eigen::Matrix3d K;
    Pose world_from_camera;
    cv::Size size;
};
std::vector<VirtualView> probe_views(std::span<const ProbeRig> rigs);

/// Returns the parallax that an inverse depth of 1/m has between a probe and a view halfway to the
/// next one, px m.
double largest_parallax_px_m(std::span<const VirtualView> probes);

/// Returns how far a probe lies from a view, m. A way ahead or back counts less than one aside,
/// since it uncovers less.
double way_m(const VirtualView& probe, const VirtualView& view);

}  // namespace vantage
