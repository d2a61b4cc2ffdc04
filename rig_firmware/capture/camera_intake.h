#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/gl/fullscreen_pass.h"
#include "common/gl/objects/dma_buf_texture.h"
#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"
#include "common/rectification/raw_planes.h"
#include "rig_firmware/capture/lent_picture.h"

namespace vantage {

/// Brings the pictures of one side to the GPU as RGBA textures. A lent picture's buffer is imported
/// as it is where the driver can, and converted there; where it cannot, its bytes are copied there
/// and converted just so. Buffers go round, and so each is imported once. Used in one context.
class CameraIntake {
  public:
    struct Counts {
        std::uint64_t imported = 0;
        std::uint64_t copied = 0;  ///< of lent pictures
    };

    /// `context` and `library` must outlive it.
    CameraIntake(const EglContext& context, const ShaderLibrary& library, cv::Size size);

    /// Imports the buffer on trial and builds the programs for its format. From then on pictures
    /// are imported if that worked; until then they are copied. `why_not`: not empty to only build.
    /// `warm_up`: what will be done with planes(), where bring() will not be called.
    void prepare(const LentPicture& specimen, const std::string& why_not = {},
                 const std::function<void(const RawPlanes&)>& warm_up = {});

    bool imports() const { return imports_; }
    /// Why pictures are copied; empty if they are not.
    const std::string& reason() const { return reason_; }

    /// The texture is valid until the next call; a lent picture has to be kept until the GPU is
    /// through with it. Throws Error if it is not of this intake's size.
    const Texture& bring(const ColourImage& picture);
    const Texture& bring(const LentPicture& picture);
    /// The same without the conversion, for RectifyPass, which makes it on the way.
    RawPlanes planes(const LentPicture& picture);

    const Counts& counts() const { return counts_; }

  private:
    const std::vector<DmaBufTexture>& imported(const LentPicture& picture);
    void copy(const LentPicture& picture);
    FullscreenPass& pass_for(PixelFormat format);

    const EglContext& context_;
    const ShaderLibrary& library_;
    Texture colour_;
    Framebuffer target_;
    std::optional<PixelFormat> format_;  ///< that pass_ is for
    std::optional<FullscreenPass> pass_;
    std::vector<Texture> copies_;  ///< planes of a picture that is not imported
    std::shared_ptr<const void> camera_;
    std::map<unsigned, std::vector<DmaBufTexture>> imports_of_;  ///< by index of camera_'s buffers
    bool imports_ = false;
    std::string reason_ = "no buffer was offered";
    Counts counts_;
};

}  // namespace vantage
