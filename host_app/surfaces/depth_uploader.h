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

/// Uploads a view's depth. Disparities are uploaded as 16 bits for each pixel and converted to
/// metres by a table of all 65536 values, so that every GPU gives the same bits as the CPU. The
/// context that was current at construction must be current at every call.
class DepthUploader {
  public:
    /// Uploads to `into` (r32f, metres, 0 = unknown), which gets the size of the view's depth.
    /// Precondition: the view has disparities.
    void upload(const DepthView& view, DrawnTexture& into);

  private:
    const Texture& table_of(const DisparityScale& scale);

    ShaderLibrary library_;
    FullscreenPass pass_{library_, "disparity_depth.frag"};
    std::optional<Texture> steps_;
    std::vector<std::pair<DisparityScale, Texture>> tables_;  ///< one for each geometry
};

/// Uploads a view's depth map or disparities to `into`, as DepthUploader does. Creates `uploader`
/// when a view first has disparities. Precondition: the view has depth.
void upload_depth(const DepthView& view, std::unique_ptr<DepthUploader>& uploader,
                  DrawnTexture& into);

}  // namespace vantage
