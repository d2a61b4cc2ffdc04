#pragma once

#include <optional>

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/program.h"
#include "common/gl/objects/texture.h"
#include "rig_firmware/stereo/features/exposure_pass.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/volume/stereo_layout.h"

namespace vantage {

/// Whether LumaPass's pictures are for themselves, or follow one another from one place.
enum class PictureKind { single, of_stream };

/// Luma of both pictures and behind it, in a plane of its own, their colour: half of red - blue,
/// from 128 up. Four pixels a word (see StereoLayout).
/// In a stream, still pixels are averaged over time against sensor noise: the value moves a half, a
/// quarter, at last an eighth of the way to the new one.
class LumaPass {
  public:
    /// Largest distance of a still pixel from its mean, in grey levels: five times a sensor noise
    /// of 2.
    static constexpr int max_noise = 10;

    LumaPass(const ShaderLibrary& library, const StereoLayout& layout,
             PictureKind kind = PictureKind::single);

    /// From rgba8 textures of the layout's size.
    void run(PassProfiler& profiler, const Texture& left, const Texture& right);
    /// The next pair starts anew.
    void forget() { has_state_ = false; }

    const Buffer& left() const { return left_; }
    const Buffer& right() const { return right_; }
    std::size_t gpu_bytes() const {
        return left_.bytes() + right_.bytes() +
               (left_memory_ ? left_memory_->state.bytes() + right_memory_->state.bytes() : 0U);
    }

  private:
    /// What a stream of one camera's pictures leaves.
    struct Memory {
        ExposurePass exposure;
        Buffer state;
    };

    void convert(const Texture& picture, const Buffer& luma, std::optional<Memory>& memory);

    StereoLayout layout_;
    Program program_;
    Buffer left_, right_;
    std::optional<Memory> left_memory_, right_memory_;
    bool has_state_ = false;
};

}  // namespace vantage
