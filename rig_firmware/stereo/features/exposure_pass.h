#pragma once

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/program.h"
#include "common/gl/objects/texture.h"
#include "common/gl/shader_library.h"
#include "rig_firmware/stereo/disparity/exposure_reference.h"

namespace vantage {

/// By what factor each picture of a stream is brighter than the one before: what automatic
/// exposure and lamps do to all of a picture, found among what stands still in it.
class ExposurePass {
  public:
    explicit ExposurePass(const ShaderLibrary& library);

    /// picture: rgba8.
    void run(const Texture& picture);

    /// Its first int is the gain, in 1/4096.
    const Buffer& gain() const { return exposure_; }

  private:
    Program program_;
    Buffer exposure_;
    bool has_luma_ = false;
};

}  // namespace vantage
