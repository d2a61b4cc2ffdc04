#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/av/av_handles.h"
#include "common/image/image.h"

namespace vantage {

/// Converts RGBA images to another pixel format; YUV is ITU-R BT.709 in studio range. Not
/// thread-safe.
class PictureConverter {
  public:
    /// Throws Error if FFmpeg cannot convert to that format.
    PictureConverter(int width_px, int height_px, AVPixelFormat format);

    /// The image has at least the converter's size; the rest is cropped. The frame is valid until
    /// the next call.
    AVFrame& convert(const ColourImage& picture);

  private:
    SwsContextPtr context_;
    AvFramePtr frame_;
};

struct EncoderSettings {
    int width_px = 0, height_px = 0;  ///< of the frames; an odd last row or column is cropped
    double rate_hz = 30;              ///< 29.97 and similar rates are n * 1000 / 1001
    /// Empty: whatever the quality needs.
    std::optional<std::int64_t> bit_rate_bps = {};
    double quality = 20;    ///< x264's constant rate factor, 0 (lossless) .. 51, or the equivalent
    bool is_live = false;   ///< no reordered frames, and a key frame every second
    bool has_head = false;  ///< the container stores the codec's header once, at its start

    bool operator==(const EncoderSettings&) const = default;
};

/// Names of the supported encoders in the order in which they are tried, fastest first.
std::vector<std::string> known_encoders();

/// Throws Error with the most similar name if the encoder is not supported.
void require_known_encoder(const std::string& name);

/// Encoder of the programme's frames with one of FFmpeg's video encoders, in ITU-R BT.709. Frame n
/// has the time n / rate. Not thread-safe.
class PictureEncoder {
  public:
    /// Throws Error with the reason if this computer has no such encoder, or if it does not accept
    /// this size.
    PictureEncoder(const std::string& name, const EncoderSettings& settings);

    /// Codec context with time base, size and header.
    const AVCodecContext& context() const { return *context_; }
    std::string name() const { return context_->codec->name; }

    /// Encodes a frame, as a key frame if `is_key`. Numbers ascend. Throws Error if the encoder
    /// fails.
    void add(const ColourImage& picture, std::int64_t number, bool is_key = false);
    /// Signals the end of the frames.
    void end();
    /// Next finished packet, valid until the next call; null if there is none now. Throws Error if
    /// the encoder fails.
    AVPacket* next();

  private:
    void set_quality(const EncoderSettings& settings);
    void use_vaapi();

    AvCodecContextPtr context_;
    std::optional<PictureConverter> converter_;
    AvBufferPtr device_;
    AvFramePtr uploaded_;  ///< used if the encoder reads from GPU memory
    AvPacketPtr packet_;
};

/// Returns the first of known_encoders() that encodes a test frame with these settings; with
/// `request`, only that one is tried. Logs the choice and why others failed. Throws Error if none
/// works.
std::string choose_encoder(const std::string& request, const EncoderSettings& settings);

}  // namespace vantage
