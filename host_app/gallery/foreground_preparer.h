#pragma once

#include <memory>
#include <vector>

#include "common/gl/fullscreen_pass.h"
#include "host_app/background/background_model.h"
#include "host_app/pipeline/instant_preparer.h"
#include "host_app/surfaces/recycle_pool.h"
#include "host_app/surfaces/rig_history.h"
#include "host_app/surfaces/rig_surface.h"

namespace vantage {

/// The foreground of an instant, separated from the background, for each rig in the order of
/// Instant::rigs. The surfaces of Instant::rigs are unchanged.
struct ForegroundInstant final : InstantExtra {
    struct Matte {
        /// r8, in the image's size: the foreground's share of each pixel.
        DrawnTexture share{TextureFormat::r8, Filter::linear};
    };
    struct Rig {
        std::shared_ptr<const RigSurface> background;  ///< as the rig has learnt it, with colour
        std::shared_ptr<const Matte> matte;
        bool is_known =
            false;  ///< the background has been seen for long enough to separate the foreground
    };
    std::vector<Rig> rigs;
};

/// Learns every rig's background over time, as the product does (BackgroundModel), and separates
/// the foreground from it; refines nothing.
class ForegroundPreparer final : public InstantPreparer {
  public:
    explicit ForegroundPreparer(const ShaderLibrary& library)
        : sets_(library), triangles_(library), copy_(library, "copy.frag") {}

    void take(std::span<const DepthView> views, double dt_s) override;
    std::shared_ptr<const Instant> prepare(const VirtualView& target,
                                           const PrepareLevel& level) override;
    void keep_only(const std::set<std::string>& rigs) override { (void)rigs_.keep_only(rigs); }

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
