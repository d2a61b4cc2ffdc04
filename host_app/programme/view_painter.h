#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/gl/objects/readback.h"
#include "common/image/image.h"
#include "common/image/picture_pool.h"
#include "host_app/flight/camera_state.h"
#include "host_app/programme/coarse_depth.h"
#include "host_app/synthesis/source_map.h"
#include "host_app/synthesis/stereoscopy.h"
#include "host_app/synthesis/synthesiser.h"

namespace vantage {

/// Size of the programme's frames, and the eyes of a 3D display.
struct PictureFormat {
    int width_px = 1280, height_px = 720;
    /// Empty: one eye. By default the eyes converge at the focus.
    std::optional<Stereoscopy> stereoscopy = {};
};

/// The view of a camera in a frame of this size.
VirtualView view_of(const CameraState& camera, cv::Size size);

/// The source map of a frame: as a picture, as shares, and its legend.
struct SourceMap {
    ColourImage picture;
    SourceShares shares;  ///< with two eyes, of the right one
    std::vector<SourceMapOverlay::Key> legend;
};

/// Renders frames of instants and reads them back. The context that was current at construction
/// must be current at every call.
class ViewPainter {
  public:
    ViewPainter(const SynthesiserEntry& synthesiser, const PictureFormat& format,
                const ShaderLibrary& shaders);

    /// Renders a frame and waits for the GPU. Levels that render a smaller size are enlarged to the
    /// size of the format. Fills `sources` with the source map and `inverse_depth` with the grid of
    /// CoarseDepth (with one eye only), unless they are null or the synthesiser does not provide
    /// them.
    ColourImage paint(const Instant& instant, const CameraState& camera, const RenderLevel& level,
                      std::optional<SourceMap>* sources = nullptr,
                      cv::Mat1f* inverse_depth = nullptr);
    double last_readback_ms() const { return readback_ms_; }

  private:
    const Texture& render(const Instant& instant, const CameraState& camera, cv::Size size,
                          const RenderLevel& level, bool is_map);

    PictureFormat format_;
    std::unique_ptr<ViewRenderer> renderer_;
    SourceMapOverlay overlay_;
    EyeMosaic mosaic_;
    const Texture* last_eye_ = nullptr;  ///< result of the last render(), without the source map
    std::string lacking_;                ///< reported limit of the last frame; empty: none
    Readback readback_;
    PicturePool pictures_;
    ColourImage small_;  ///< memory for frames that are rendered smaller
    CoarseDepth coarse_depth_;
    double readback_ms_ = 0;
};

/// Marks large areas of a rendered frame that no rig saw, with dark hatching. It starts at 1/20 of
/// the frame's width from the nearest pixel that was seen and is opaque from 1/10 on. Smaller holes
/// keep their inpainted content, which is plausible there. Alpha is that of ViewRenderer::render().
void mark_unseen(ColourImage& picture);

}  // namespace vantage
