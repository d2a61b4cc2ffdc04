#pragma once

#include "common/gl/fullscreen_pass.h"
#include "common/gl/objects/readback.h"
#include "host_app/surfaces/drawn_texture.h"

namespace vantage {

/// What a rendered picture shows, coarsely: the inverse of the nearest depth in every cell of a
/// grid, read back. The context that was current at construction must be current at every call.
class CoarseDepth {
  public:
    explicit CoarseDepth(const ShaderLibrary& library) : pass_(library, "coarse_depth.frag") {}

    /// `depth_m` as of ViewRenderer::depth_m().
    void begin(const Texture& depth_m);
    bool is_begun() const { return readback_.is_begun(); }
    /// 1/m, 0 where nothing is; of the picture's shape. Waits until it is here. Precondition:
    /// is_begun().
    cv::Mat1f take() { return readback_.take(); }

  private:
    FullscreenPass pass_;
    DrawnTexture grid_{TextureFormat::r32f};
    Readback readback_;
};

}  // namespace vantage
