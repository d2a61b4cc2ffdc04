#pragma once

#include <memory>
#include <vector>

#include "host_app/surfaces/rig_surface.h"

namespace vantage {

/// The most rigs that one picture is made of.
inline constexpr std::size_t most_drawn_rigs = 4;

/// One rig's part in an instant.
struct InstantRig {
    std::shared_ptr<const RigSurface> surface;
    /// A second layer of the same camera before it; null where the preparer makes none. Of
    /// performers, colours are times alpha, which is their share of the pixel, and depth goes on
    /// beyond them, negative.
    std::shared_ptr<const RigSurface> boundary = nullptr;
    /// How far the rig takes part, 0..1: it fades in when it comes and out when it is gone.
    float presence = 1;

    const DepthView& camera() const { return surface->camera(); }
    std::span<const Eigen::Vector3d> sample_points_m() const { return surface->sample_points_m(); }
};

/// What a preparer tells beside the rigs' surfaces, to the renderer of the same synthesiser.
struct InstantExtra {
    virtual ~InstantExtra() = default;
};

/// A frame set made ready to be rendered. Immutable: any thread may hold and render it.
struct Instant {
    std::vector<InstantRig> rigs;
    int level = 0;  ///< the rank of the PrepareLevel that it was made at
    std::shared_ptr<const InstantExtra> extra = nullptr;  ///< null where there is nothing to tell
};

}  // namespace vantage
