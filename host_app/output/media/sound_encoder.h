#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "common/av/av_handles.h"
#include "common/av/sound.h"

namespace vantage {

/// Encodes a programme's sound with one of FFmpeg's encoders. Times of packets are samples since
/// the first one; a packet before that is what the encoder needs to begin.
class SoundEncoder {
  public:
    enum class Codec {
        pcm,  ///< 24 bits, as it is
        aac,  ///< 192 kbit/s
    };
    /// `has_head`: as EncoderSettings. Throws Error if FFmpeg has no such encoder.
    SoundEncoder(Codec codec, bool has_head);

    /// Of its time base and head.
    const AVCodecContext& context() const { return *context_; }
    /// What comes next. Throws Error if the encoder fails.
    void add(std::span<const float> samples);
    /// No more follow.
    void end();
    /// The next packet that is done, good until the next call; null: none now.
    AVPacket* next();

  private:
    void send(std::size_t count);
    void drain();

    AvCodecContextPtr context_;
    AvFramePtr frame_;
    std::deque<AvPacketPtr> done_;
    AvPacketPtr given_;           ///< by next()
    std::vector<float> waiting_;  ///< for a whole frame of the encoder's
    std::int64_t sent_ = 0;
};

/// A programme's sound on its way to one file or stream: goes on from tick to tick, silent where
/// something was left out, so that it stays with the pictures.
class SoundTrack {
  public:
    SoundTrack(double rate_hz, SoundEncoder::Codec codec, bool has_head)
        : grid_(rate_hz), encoder_(codec, has_head) {}

    SoundEncoder& encoder() { return encoder_; }
    /// Of a tick, counted from the first picture's.
    void add(const SoundBlock& block, std::int64_t tick);

  private:
    SoundGrid grid_;
    SoundEncoder encoder_;
    std::int64_t next_ = 0;  ///< sample, as blocks count them
    bool has_begun_ = false;
};

}  // namespace vantage
