#pragma once

#include "common/gl/tile_pass.h"
#include "host_app/refine/multi_view_refinement.h"
#include "host_app/surfaces/rig_history.h"

namespace vantage {

/// Finds the depth of what stands before a rig's set.
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

    /// Draws the rig's, r32f of its depth map's size: metres, 0 = none, negative beyond its matte.
    /// `all`, of this instant, may hold the rig itself. Precondition: a SetLearner has learnt of
    /// all of them.
    void find(const RigHistory& rig, std::span<RigHistory* const> all, const Framebuffer& found);

    /// The same, bettered by the other rigs. Precondition: their performer_depth() was found, and
    /// the rig's.
    void better(const RigHistory& rig, std::span<RigHistory* const> all, const Framebuffer& found);

  private:
    static constexpr std::size_t max_others = MultiViewRefinement::max_others;

    /// Those whose silhouettes are looked at.
    static std::vector<const RigHistory*> others_of(const RigHistory& rig,
                                                    std::span<RigHistory* const> all);
    /// Gives the program the mattes and backgrounds of the other rigs.
    static void set_others(Program& program, const RigHistory& rig,
                           std::span<const RigHistory* const> others);
    void carve(const RigHistory& rig, std::span<const RigHistory* const> others);
    /// For the holes in what is left that are too wide for their edges.
    const Texture& look_far(const RigHistory& rig, std::span<const RigHistory* const> others);
    /// Fills and smooths. `far_m`: of look_far(), or null.
    void close(const Texture& depth_m, const Texture* far_m, const RigHistory& rig,
               const Framebuffer& closed);

    std::vector<TilePass> carve_, look_far_;  ///< one for every number of other rigs
    TilePass close_, close_from_afar_;
    MultiViewRefinement refinement_;
    DrawnTexture carved_{TextureFormat::r32f}, far_{TextureFormat::r32f};
};

}  // namespace vantage
