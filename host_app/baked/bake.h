#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "host_app/views/depth_view.h"

namespace vantage {

/// The part of a baked background that one rig owns, as a mesh in that rig's depth map.
struct BakedPart {
    static constexpr std::size_t max_sources = 4;

    /// (u * z, v * z, z): a place in the owner's depth map, px, and its depth, metres.
    std::vector<Eigen::Vector3f> vertices;
    /// Triangles. The first `measured` indices belong to surfaces that a rig has measured, the
    /// others to inpainted ones, which show where nothing was measured.
    std::vector<std::uint32_t> indices;
    std::size_t measured = 0;
    /// The views whose colours the part blends, the owner first; -1: none.
    std::array<int, max_sources> sources{-1, -1, -1, -1};
    /// Of the size of the owner's depth map. Channel k is how well sources[k] sees the surface
    /// there: 0 if it is hidden from that view.
    ColourImage weights;
};

/// A baked background: a mesh of everything that stands still, in parts that do not repeat each
/// other, with the views' clean colours.
struct BakedBackground {
    /// Cameras and colours, without depth. The alpha of a colour is its edge confidence.
    std::vector<DepthView> views;
    std::vector<BakedPart> parts;  ///< one for each view, owned by it
};

/// Decides once what every frame would have to decide again: which surfaces the rigs agree on,
/// which rig's depth is the best for each, and which rigs see it. A surface belongs to the rig that
/// has the most pixels for it, clear of depth edges (nearest, most frontal, most confident); the
/// others leave it out. A surface that more rigs see through than have is left out everywhere (see
/// fused_depth.frag). Meshes end at depth edges; planes become large triangles.
///
/// Takes 0.25 s for each of four rigs of 320x240 on one thread.
///
/// @param views each rig's refined background: `depth_m` has 0 where it is unknown and negative
///     values where it is inpainted; `colour` is its clean picture
/// @return nothing if `stop` was requested
std::optional<BakedBackground> bake_background(std::span<const DepthView> views,
                                               const std::stop_token& stop = {});

}  // namespace vantage
