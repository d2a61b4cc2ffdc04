#pragma once

#include "common/gl/tile_pass.h"
#include "host_app/refine/multi_view_refinement.h"
#include "host_app/surfaces/rig_history.h"

namespace vantage {

/// Computes the depth of a rig's foreground. Belongs to one context.
class ForegroundDepth {
  public:
    explicit ForegroundDepth(const ShaderLibrary& library)
        : close_(library, "foreground_depth.frag"),
          close_from_afar_(library, "foreground_depth.frag", {{"FAR", "1"}}),
          refinement_(library) {
        for (std::size_t others = 0; others <= max_others; ++others) {
            const ShaderDefines count{{"OTHERS", std::to_string(others)}};
            carve_.emplace_back(library, "foreground_carve.frag", count);
            look_far_.emplace_back(library, "foreground_far.frag", count);
        }
    }

    /// Draws the rig's foreground depth, r32f in the size of its depth map: metres, 0 = none,
    /// negative outside the matte. `all` are the rigs of this instant and may include the rig
    /// itself. Precondition: a BackgroundModel has learnt all of them.
    void find(const RigHistory& rig, std::span<RigHistory* const> all, const Framebuffer& found);

    /// Draws the same, refined by the other rigs. Precondition: the foreground_depth() of all of
    /// them was computed.
    void better(const RigHistory& rig, std::span<RigHistory* const> all, const Framebuffer& found);

  private:
    static constexpr std::size_t max_others = MultiViewRefinement::max_others;

    /// Returns the rigs whose silhouettes are compared.
    static std::vector<const RigHistory*> others_of(const RigHistory& rig,
                                                    std::span<RigHistory* const> all);
    /// Gives the program the mattes and backgrounds of the other rigs.
    static void set_others(Program& program, const RigHistory& rig,
                           std::span<const RigHistory* const> others);
    void carve(const RigHistory& rig, std::span<const RigHistory* const> others);
    /// Computes depth for holes that are too wide to be filled from their edges.
    const Texture& look_far(const RigHistory& rig, std::span<const RigHistory* const> others);
    /// Fills holes and smooths. `far_m` is the result of look_far(), or null.
    void close(const Texture& depth_m, const Texture* far_m, const RigHistory& rig,
               const Framebuffer& closed);

    std::vector<TilePass> carve_, look_far_;  ///< one for every number of other rigs
    TilePass close_, close_from_afar_;
    MultiViewRefinement refinement_;
    DrawnTexture carved_{TextureFormat::r32f}, far_{TextureFormat::r32f};
};

}  // namespace vantage
