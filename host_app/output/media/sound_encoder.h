#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "common/av/av_handles.h"
#include "common/av/sound.h"

namespace vantage {

/// Encoder of the programme's sound with one of FFmpeg's encoders. Packet times are in samples
/// since the first sample; packets with negative times are the encoder's priming. Not thread-safe.
class SoundEncoder {
  public:
    enum class Codec {
        pcm,  ///< 24 bits, uncompressed
        aac,  ///< 192 kbit/s
    };
    /// `has_head`: see EncoderSettings. Throws Error if FFmpeg has no such encoder.
    SoundEncoder(Codec codec, bool has_head);

    /// Codec context with time base and header.
    const AVCodecContext& context() const { return *context_; }
    /// Encodes the next samples. Throws Error if the encoder fails.
    void add(std::span<const float> samples);
    /// Signals the end of the sound.
    void end();
    /// Next finished packet, valid until the next call; null if there is none now.
    AVPacket* next();

  private:
    void send(std::size_t count);
    void drain();

    AvCodecContextPtr context_;
    AvFramePtr frame_;
    std::deque<AvPacketPtr> done_;
    AvPacketPtr given_;           ///< returned by next()
    std::vector<float> waiting_;  ///< samples for the encoder's next complete frame
    std::int64_t sent_ = 0;
};

/// Continuous sound track for one file or stream. Ticks that were dropped become silence, so that
/// the sound stays in sync with the frames.
class SoundTrack {
  public:
    SoundTrack(double rate_hz, SoundEncoder::Codec codec, bool has_head)
        : grid_(rate_hz), encoder_(codec, has_head) {}

    SoundEncoder& encoder() { return encoder_; }
    /// Adds the sound of a tick; ticks count from the first frame.
    void add(const SoundBlock& block, std::int64_t tick);

  private:
    SoundGrid grid_;
    SoundEncoder encoder_;
    std::int64_t next_ = 0;  ///< next sample, in the blocks' count
    bool has_begun_ = false;
};

}  // namespace vantage
