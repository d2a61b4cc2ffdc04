#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "common/gl/fullscreen_pass.h"
#include "common/gl/shader_library.h"
#include "host_app/surfaces/drawn_texture.h"
#include "host_app/views/depth_view.h"

namespace vantage {

/// Brings a view's depth to the GPU: disparities as they came, 16 bits a pixel, turned into metres
/// there by a table of all 65536, so that every GPU gives the processor's very bits. The context
/// that was current at construction must be current at every call.
class DepthUploader {
  public:
    /// `into`: r32f, takes the size of the view's depth: metres, 0 = unknown. Precondition: the
    /// view has depth.
    void upload(const DepthView& view, DrawnTexture& into);

  private:
    const Texture& table_of(const DisparityScale& scale);

    ShaderLibrary library_;
    FullscreenPass pass_{library_, "disparity_depth.frag"};
    std::optional<Texture> steps_;
    std::vector<std::pair<DisparityScale, Texture>> tables_;  ///< of the rigs' geometries
};

/// `uploader` is made when a view first needs one.
void upload_depth(const DepthView& view, std::unique_ptr<DepthUploader>& uploader,
                  DrawnTexture& into);

}  // namespace vantage
