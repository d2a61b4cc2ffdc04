#pragma once

#include <memory>
#include <vector>

#include "common/gl/fullscreen_pass.h"
#include "host_app/background/background_model.h"
#include "host_app/pipeline/instant_preparer.h"
#include "host_app/surfaces/recycle_pool.h"
#include "host_app/surfaces/rig_roster.h"
#include "host_app/surfaces/triangle_builder.h"

namespace vantage {

/// What an instant shows of the performers apart from the set; a rig each in the order of
/// Instant::rigs, whose surfaces are as they came.
struct ForegroundInstant final : InstantExtra {
    struct Matte {
        /// r8, of the picture's size: the performers' share of each pixel.
        DrawnTexture share{TextureFormat::r8, Filter::linear};
    };
    struct Rig {
        std::shared_ptr<const RigSurface> set;  ///< what the rig has learnt of it, its colour too
        std::shared_ptr<const Matte> matte;
        bool is_known = false;  ///< the set has been seen long enough to tell performers from it
    };
    std::vector<Rig> rigs;
};

/// Learns the set of every rig along time, as the product does (SetLearner), and hands on what it
/// tells from it; nothing is bettered.
class ForegroundPreparer final : public InstantPreparer {
  public:
    explicit ForegroundPreparer(const ShaderLibrary& library)
        : sets_(library), triangles_(library), copy_(library, "copy.frag") {}

    void take(std::span<const DepthView> views, double dt_s) override;
    std::shared_ptr<const Instant> prepare(const VirtualView& target,
                                           const PrepareLevel& level) override;

  private:
    std::shared_ptr<RigSurface> surface_of(const RigHistory& rig, const Texture& depth_m,
                                           const Texture& colour);
    void copy(const Texture& source, const Framebuffer& target);

    RigRoster rigs_;
    BackgroundModel sets_;
    TriangleBuilder triangles_;
    FullscreenPass copy_;
    RecyclePool<RigSurface> surfaces_;
    RecyclePool<ForegroundInstant::Matte> mattes_;
    std::shared_ptr<const Instant> instant_ = std::make_shared<Instant>();
};

}  // namespace vantage
