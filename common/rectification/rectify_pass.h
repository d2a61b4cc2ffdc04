#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "common/geometry/rectification_map.h"
#include "common/gl/fullscreen_pass.h"
#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"
#include "common/gl/shader_library.h"
#include "common/rectification/raw_planes.h"

namespace vantage {

/// Rectifies the raw pictures of one camera of a stereo rig on the GPU, for any lens that OpenCV's
/// models describe. Built once for a calibration; every call reuses its GL objects. The context
/// that was current at construction must be current at every call; `library` must outlive it.
class RectifyPass {
  public:
    /// Throws Error if the raw or the rectified size is beyond the GPU's limits.
    RectifyPass(const ShaderLibrary& library, const StereoCalibration& calibration, Side side);

    /// raw: rgba8, of the size that the camera was calibrated for (Error naming both sizes if not).
    /// The result is rgba8 of the calibration's rectified size, opaque black where the raw picture
    /// shows nothing, owned by this pass and valid until the next call; if the calibration says
    /// that the camera is rectified already, it is `raw` itself and costs nothing. Sampled
    /// bilinearly.
    const Texture& rectify(const Texture& raw);
    /// The same of a camera's buffer, in one pass: YUV is resampled first and converted then. The
    /// camera must not be rectified already. Compiles a program at the first call for a format.
    const Texture& rectify(const RawPlanes& raw);

    bool passes_through() const { return is_identity_; }

    /// Read and written in one rectify(), and held, for the reports of times and memory.
    std::size_t bytes_moved(double raw_bytes_per_pixel = 4) const;
    std::size_t gpu_bytes() const;

  private:
    void require_raw_size(cv::Size size) const;
    const Texture& run(FullscreenPass& pass, Program& program);

    const ShaderLibrary& library_;
    std::string calibration_id_;
    Side side_;
    cv::Size raw_size_;
    bool is_identity_;
    std::optional<cv::Mat1i> packed_;  ///< until it is on the GPU
    bool is_packed_;
    Texture positions_, rectified_;
    Framebuffer target_;
    FullscreenPass pass_;
    std::optional<FullscreenPass> planes_pass_;
    int planes_format_ = -1;  ///< that planes_pass_ is for
};

}  // namespace vantage
