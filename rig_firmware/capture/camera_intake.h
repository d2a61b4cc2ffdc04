#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/gl/fullscreen_pass.h"
#include "common/gl/objects/dma_buf_texture.h"
#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"
#include "rig_firmware/capture/lent_picture.h"

namespace vantage {

/// Uploads the images of one camera to the GPU as RGBA textures. A lent buffer is imported without
/// a copy if the driver can, and converted on the GPU; otherwise its bytes are uploaded and
/// converted in the same way. Drivers reuse their buffers, so that each is imported once. Use it in
/// one GL context.
class CameraIntake {
  public:
    struct Counts {
        std::uint64_t imported = 0;
        std::uint64_t copied = 0;  ///< lent images only
    };

    /// `context` and `library` must outlive this object.
    CameraIntake(const EglContext& context, const ShaderLibrary& library, cv::Size size);

    /// Tries to import the buffer and compiles the programs for its format. If the import works,
    /// images are imported from then on; otherwise they are copied. If `why_not` is not empty, it
    /// is the reason to copy, and no import is tried.
    void prepare(const LentPicture& specimen, const std::string& why_not = {});

    bool imports() const { return imports_; }
    /// Reason why images are copied; empty if they are imported.
    const std::string& reason() const { return reason_; }

    /// Uploads one image. The texture is valid until the next call; the caller keeps a lent image
    /// until the GPU has finished with it. Throws Error if the size is not that of this intake.
    const Texture& bring(const ColourImage& picture);
    const Texture& bring(const LentPicture& picture);

    const Counts& counts() const { return counts_; }

  private:
    const std::vector<DmaBufTexture>& imported(const LentPicture& picture);
    void copy(const LentPicture& picture);
    FullscreenPass& pass_for(PixelFormat format);

    const EglContext& context_;
    const ShaderLibrary& library_;
    Texture colour_;
    Framebuffer target_;
    std::optional<PixelFormat> format_;  ///< the format of pass_
    std::optional<FullscreenPass> pass_;
    std::vector<Texture> copies_;  ///< planes of an image that is not imported
    std::shared_ptr<const void> camera_;
    std::map<unsigned, std::vector<DmaBufTexture>> imports_of_;  ///< by buffer index of camera_
    bool imports_ = false;
    std::string reason_ = "no buffer was offered";
    Counts counts_;
};

}  // namespace vantage
