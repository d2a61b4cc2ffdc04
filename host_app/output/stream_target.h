#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host_app/output/media/shared_encoder.h"
#include "host_app/output/media/sound_encoder.h"
#include "host_app/output/output_target.h"

namespace vantage {

/// Network stream by FFmpeg: H.264 of a shared encoder, and AAC if there is sound, in MPEG-TS. A
/// frame is sent before write_encoded() returns; receivers can join at any second.
class StreamTarget final : public OutputTarget {
  public:
    struct Settings {
        std::string url;  ///< FFmpeg's URL, without secrets
        std::vector<std::pair<std::string, std::string>>
            options;  ///< FFmpeg's options of the protocol
        /// Possible reasons for a peer that does not answer, for the error message; may be empty.
        std::string silence = {};
        std::shared_ptr<SharedEncoder> encoder;
        bool has_sound = false;
        bool is_listening = false;  ///< a lost peer is a caller that has left
    };
    /// Waits for a peer if the protocol has one. Throws Error if there is none, if it refuses, or
    /// if patience is over. `patience` must outlive this object.
    StreamTarget(const Settings& settings, const OutputPatience& patience);

    void write_encoded(const EncodedPicture& picture, std::int64_t tick) override;
    void hear(const SoundBlock& sound, std::int64_t tick) override;
    void finish() override;
    std::uint64_t bytes() const override;

  private:
    [[noreturn]] void fail_for_peer(const char* what, int code) const;
    void send_sound();
    AVStream& add_stream(const AVCodecParameters& parameters, AVRational time_base);
    void mux(AVPacket& packet, AVRational time_base, const AVStream& stream);

    AvOutputPtr output_;
    bool is_listening_;
    std::optional<SharedEncoder::Use> encoder_;
    AvPacketPtr packet_;
    std::optional<SoundTrack> sound_;
    AVStream* stream_ = nullptr;        ///< owned by output_
    AVStream* sound_stream_ = nullptr;  ///< owned by output_
};

/// The encoder of a stream, which streams of equal settings share: a constant bit rate, from the
/// option `bitrate` or by the size. Throws Error for an odd size, which H.264 at 4:2:0 does not
/// support.
std::shared_ptr<SharedEncoder> stream_encoder(const OutputUrl& url, const OutputFormat& format);

}  // namespace vantage
