#pragma once

#include "common/gl/tile_pass.h"
#include "host_app/instants/rig_consensus.h"
#include "host_app/instants/rig_history.h"

namespace vantage {

/// Finds the depth of what stands before a rig's set.
class PerformerDepth {
  public:
    explicit PerformerDepth(const ShaderLibrary& library)
        : close_(library, "performer_depth.frag"), consensus_(library) {
        for (std::size_t others = 0; others <= max_others; ++others)
            carve_.emplace_back(library, "performer_carve.frag",
                                ShaderDefines{{"OTHERS", std::to_string(others)}});
    }

    /// Draws the rig's, r32f of its depth map's size: metres, 0 = none, negative beyond its matte.
    /// `all`, of this instant, may hold the rig itself. Precondition: a SetLearner has learnt of
    /// all of them.
    void find(RigHistory& rig, std::span<RigHistory* const> all, const Framebuffer& found);

    /// The same, bettered by the other rigs. Precondition: their performer_depth() was found, and
    /// the rig's.
    void better(const RigHistory& rig, std::span<RigHistory* const> all, const Framebuffer& found);

  private:
    static constexpr std::size_t max_others = 3;

    const Texture& carve(RigHistory& rig, std::span<RigHistory* const> all);
    /// Fills and smooths.
    void close(const Texture& depth_m, const RigHistory& rig, const Framebuffer& closed);

    std::vector<TilePass> carve_;  ///< one for every number of other rigs
    TilePass close_;
    RigConsensus consensus_;
    DrawnTexture carved_{TextureFormat::r32f};
};

}  // namespace vantage
