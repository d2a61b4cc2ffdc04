#pragma once

#include <memory>
#include <vector>

#include "host_app/surfaces/rig_surface.h"

namespace vantage {

/// Limits the rigs of one picture: the shaders' arrays of samplers have this size.
inline constexpr std::size_t most_drawn_rigs = 4;

/// One rig in an instant.
struct InstantRig {
    std::shared_ptr<const RigSurface> surface;
    /// A second layer of the same camera before `surface`: the foreground, with colours
    /// premultiplied by alpha (the matte) and depth that continues beyond the matte, negative
    /// there. Null if the preparer makes none.
    std::shared_ptr<const RigSurface> boundary = nullptr;
    /// Weight of the rig, 0..1: it fades in when it appears and out when it is gone.
    float presence = 1;
    /// Its own picture at this instant, rgba8, trilinear; null unless the instant was prepared for
    /// a view near the rig (see OwnPicture).
    std::shared_ptr<const DrawnTexture> picture = nullptr;

    const DepthView& camera() const { return surface->camera(); }
    std::span<const Eigen::Vector3d> sample_points_m() const { return surface->sample_points_m(); }
};

/// Data that a preparer passes to the renderer of the same synthesiser beside the surfaces.
struct InstantExtra {
    virtual ~InstantExtra() = default;
};

/// A frame set prepared for rendering. Immutable; any thread may hold and render it.
struct Instant {
    std::vector<InstantRig> rigs;
    int level = 0;  ///< rank of the PrepareLevel that it was prepared at
    std::shared_ptr<const InstantExtra> extra = nullptr;  ///< may be null
};

}  // namespace vantage
