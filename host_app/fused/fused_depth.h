#pragma once

#include <vector>

#include "common/gl/two_stage_pass.h"
#include "host_app/surfaces/drawn_texture.h"
#include "host_app/synthesis/rig_layers.h"

namespace vantage {

/// Finds the surface that counts at every pixel of a virtual view, from all rigs' surfaces there.
/// Belongs to one context.
class FusedDepth {
  public:
    explicit FusedDepth(const ShaderLibrary& library);

    /// Precondition: at least one layer was drawn. The result is r32f in the view's size, metres,
    /// 0 = nothing, negative = inpainted; valid until the next call.
    const Texture& find(const RigLayers& layers, cv::Size size);

  private:
    std::vector<TwoStagePass> passes_;  ///< one for every number of layers
    DrawnTexture depth_m_{TextureFormat::r32f, Filter::nearest, false, DrawnWith::depth_test};
};

}  // namespace vantage
