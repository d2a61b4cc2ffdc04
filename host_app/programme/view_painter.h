#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/gl/objects/readback.h"
#include "common/image/picture_pool.h"
#include "host_app/flight/camera_state.h"
#include "host_app/programme/coarse_depth.h"
#include "host_app/synthesis/source_map.h"
#include "host_app/synthesis/stereoscopy.h"
#include "host_app/synthesis/synthesiser.h"

namespace vantage {

/// The programme's picture: one camera, or the eyes of a 3D display.
struct PictureFormat {
    int width_px = 1280, height_px = 720;
    /// Eyes that converge, where this does not say, at the focus.
    std::optional<Stereoscopy> stereoscopy = {};
};

/// The view of a camera in a picture of this size.
VirtualView view_of(const CameraState& camera, cv::Size size);

/// The source map of a picture, for people and in numbers.
struct SourceMap {
    ColourImage picture;
    SourceShares shares;  ///< of two eyes, the right one's
    std::vector<SourceMapOverlay::Key> legend;
};

/// Renders whole pictures of instants and reads them back, on the context that was current at
/// construction.
class ViewPainter {
  public:
    ViewPainter(const SynthesiserEntry& synthesiser, const PictureFormat& format,
                const ShaderLibrary& shaders);

    /// Of the format's size, whatever size is rendered at this level. Waits for the GPU. With
    /// `sources` also the source map, and with `inverse_depth` what CoarseDepth has of the picture
    /// (of one eye only), if the synthesiser can tell; else that stays as it is.
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
    const Texture* last_eye_ = nullptr;  ///< of the last render(), without its map
    std::string lacking_;                ///< for the last picture
    Readback readback_;
    PicturePool pictures_;
    ColourImage small_;  ///< as it was rendered, where that is not the format's size
    CoarseDepth coarse_depth_;
    double readback_ms_ = 0;
};

}  // namespace vantage
