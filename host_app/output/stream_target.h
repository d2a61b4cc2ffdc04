#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host_app/output/media/picture_encoder.h"
#include "host_app/output/media/sound_encoder.h"
#include "host_app/output/output_target.h"

namespace vantage {

/// A stream over a network by FFmpeg: H.264, and AAC where there is sound, in MPEG-TS. A picture is
/// on its way when write() returns; a receiver can join at any second.
class StreamTarget final : public OutputTarget {
  public:
    struct Settings {
        std::string url;                                           ///< FFmpeg's, without secrets
        std::vector<std::pair<std::string, std::string>> options;  ///< FFmpeg's of its protocol
        /// What a peer that does not answer may mean; empty: there is no more to say.
        std::string silence = {};
        std::string encoder;
        EncoderSettings encoding;
        bool has_sound = false;
        bool is_listening = false;  ///< a peer that is gone is a caller that has left
    };
    /// Waits for a peer where the protocol has one. Throws Error if there is none, or it refuses,
    /// or patience is over; `patience` must outlive this.
    StreamTarget(const Settings& settings, const OutputPatience& patience);

    void write(const ColourImage& picture, std::int64_t tick, const std::string& timecode) override;
    void hear(const SoundBlock& sound, std::int64_t tick) override;
    void finish() override;
    std::uint64_t bytes() const override;

  private:
    [[noreturn]] void fail_for_peer(const char* what, int code) const;
    void send();
    void send_sound();
    AVStream& add_stream(const AVCodecContext& encoder);
    void write(AVPacket& packet, const AVCodecContext& encoder, const AVStream& stream);

    AvOutputPtr output_;
    bool is_listening_;
    std::optional<PictureEncoder> encoder_;
    std::optional<SoundTrack> sound_;
    AVStream* stream_ = nullptr;        ///< owned by output_
    AVStream* sound_stream_ = nullptr;  ///< likewise
};

/// What every stream of a programme is encoded with: a constant bit rate, by the option `bitrate`
/// or one that suits the size. Throws Error for an odd size, which H.264 at 4:2:0 has not.
EncoderSettings stream_encoding(const OutputUrl& url, const OutputFormat& format);

}  // namespace vantage
