#pragma once

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/program.h"
#include "common/gl/objects/texture.h"
#include "common/gl/shader_library.h"

namespace vantage {

/// By what factor each picture of a stream is brighter than the one before: what automatic
/// exposure and lamps do to all of a picture, found among what stands still in it.
class ExposurePass {
  public:
    /// Size of the grid of samples over the picture.
    static constexpr int columns = 32, rows = 24;
    /// Largest change of a sample that counts as still, in grey levels: against the previous
    /// picture as it was, then against it after the first estimate of the gain.
    static constexpr int max_first_change = 24, max_change = 8;
    /// Smaller changes of the gain, in 1/4096, are noise and count as none.
    static constexpr int min_gain_change = 8;

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
