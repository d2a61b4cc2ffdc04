#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/av/av_handles.h"
#include "host_app/output/media/picture_converter.h"

namespace vantage {

struct EncoderSettings {
    int width_px = 0, height_px = 0;  ///< of the pictures; an odd last row or column is left out
    double rate_hz = 30;              ///< 29.97 and its like are n * 1000 / 1001
    /// Nothing: what the quality needs.
    std::optional<std::int64_t> bit_rate_bps = {};
    double quality = 20;    ///< x264's constant rate factor, 0 (lossless) .. 51, or what is like it
    bool is_live = false;   ///< no picture waits for a later one, and one may join any second
    bool has_head = false;  ///< the container has the stream's head once, at its beginning
};

/// The encoders that are tried, the fastest first.
std::vector<std::string> known_encoders();

/// Throws Error, naming the nearest one, for what is none of them.
void require_known_encoder(const std::string& name);

/// Encodes a programme's pictures with one of FFmpeg's encoders, colours by ITU-R BT.709. Picture n
/// is shown from n / rate on.
class PictureEncoder {
  public:
    /// Throws Error with the reason if there is no such encoder here, or if it does not take
    /// pictures of this size.
    PictureEncoder(const std::string& name, const EncoderSettings& settings);

    /// Of its time base, size and head.
    const AVCodecContext& context() const { return *context_; }
    std::string name() const { return context_->codec->name; }

    /// Numbers grow. Throws Error if the encoder fails.
    void add(const ColourImage& picture, std::int64_t number);
    /// No more pictures follow.
    void end();
    /// The next packet that is done, good until the next call; null: none now. Throws Error if the
    /// encoder fails.
    AVPacket* next();

  private:
    void set_quality(const EncoderSettings& settings);
    void use_vaapi();

    AvCodecContextPtr context_;
    std::optional<PictureConverter> converter_;
    AvBufferPtr device_;
    AvFramePtr uploaded_;  ///< where the encoder reads from the GPU's memory
    AvPacketPtr packet_;
};

/// The first of known_encoders() that encodes pictures of these settings when it is tried; with
/// `request` that one. Tells in the log which it is, and why those before it are not. Throws Error
/// if none does.
std::string choose_encoder(const std::string& request, const EncoderSettings& settings);

}  // namespace vantage
