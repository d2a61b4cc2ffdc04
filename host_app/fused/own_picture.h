#pragma once

#include <optional>
#include <span>

#include "common/gl/fullscreen_pass.h"
#include "host_app/surfaces/drawn_texture.h"
#include "host_app/surfaces/instant.h"
#include "host_app/views/depth_view.h"

namespace vantage {

/// How near a virtual view is to a rig, 0..1: 1 at the rig's place, and 0 from where on the rig's
/// own picture does not count, because the parallax of its typical depth is too large.
float nearness(const DepthView& rig, double typical_depth_m, const VirtualView& view);

/// The rig whose own picture counts in a virtual view, as an index, and how much it counts, 0..1.
struct NearRig {
    std::size_t rig = 0;
    float weight = 0;
};

/// Returns the nearest rig, if the view is near it and much nearer to it than to any other one: two
/// rigs that are about as near show more together. Only a rig with a picture is found.
std::optional<NearRig> near_rig(std::span<const InstantRig* const> rigs, const VirtualView& view);

/// Lays a rig's own picture over a synthesised one in a virtual view near the rig: wholly at the
/// rig's place, and less with the parallax, so that other rigs' errors of depth do not show there.
/// Belongs to one context.
class OwnPicture {
  public:
    explicit OwnPicture(const ShaderLibrary& library);

    /// Draws over `picture` (rgba8), whose depth is `depth_m` (r32f, metres, 0 = nothing). `near`
    /// is one of `rigs`. Returns the result, which is valid until the next call.
    const Texture& lay_over(const Texture& picture, const Texture& depth_m, const NearRig& near,
                            std::span<const InstantRig* const> rigs, const VirtualView& view);
    /// Likewise for the rigs' shares in the colours, which have a channel for each of `rigs`.
    const Texture& lay_over_shares(const Texture& shares, const Texture& depth_m,
                                   const NearRig& near, std::span<const InstantRig* const> rigs,
                                   const VirtualView& view);

  private:
    const Texture& draw(FullscreenPass& pass, DrawnTexture& into, const Texture& picture,
                        const Texture& depth_m, const InstantRig& near, float weight,
                        const VirtualView& view);

    FullscreenPass colours_, shares_;
    DrawnTexture picture_{TextureFormat::rgba8, Filter::linear}, shared_{TextureFormat::rgba8};
};

}  // namespace vantage
