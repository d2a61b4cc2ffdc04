#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/base/bounded_queue.h"
#include "common/image/image.h"
#include "host_app/output/media/picture_encoder.h"

namespace vantage {

/// An encoded frame, which all outputs of one encoder share. Immutable.
struct EncodedPicture {
    std::shared_ptr<const AVPacket> packet;  ///< its times count ticks
    std::uint64_t tick = 0;
    std::uint64_t number =
        0;                ///< counts the encoder's frames; a gap makes the next one undecodable
    bool is_key = false;  ///< a decoder can begin with it
    double encode_ms = 0;
};

/// Receiver of encoded frames.
class EncodedSink {
  public:
    virtual ~EncodedSink() = default;
    /// Called on the encoder's thread. Must not wait.
    virtual void take(const EncodedPicture& picture) = 0;
    /// The encoder has failed; it starts anew with the next frame. Called like take().
    virtual void note_encoder_failure(const std::string& sentence) = 0;
};

/// An encoder of live streams that several outputs share: it encodes each tick once, on a thread of
/// its own, and gives the result to every sink. It runs only while an output uses it. Thread-safe.
class SharedEncoder {
  public:
    /// `encoder` is one of known_encoders().
    SharedEncoder(std::string encoder, const EncoderSettings& settings);
    ~SharedEncoder();
    SharedEncoder(const SharedEncoder&) = delete;
    SharedEncoder& operator=(const SharedEncoder&) = delete;

    const std::string& encoder() const { return encoder_name_; }
    const EncoderSettings& settings() const { return settings_; }

    /// Keeps the encoder open during its life.
    class Use {
      public:
        /// Opens the encoder if it is not open. Throws Error like PictureEncoder.
        explicit Use(std::shared_ptr<SharedEncoder> encoder);
        ~Use();
        Use(const Use&) = delete;
        Use& operator=(const Use&) = delete;

        AVRational time_base() const { return time_base_; }
        AVRational rate() const { return rate_; }
        /// For the stream of a container.
        const AVCodecParameters& parameters() const { return *parameters_; }

      private:
        std::shared_ptr<SharedEncoder> encoder_;
        AVRational time_base_{}, rate_{};
        AvCodecParametersPtr parameters_;
    };

    /// Adds a sink, which gets all frames from now on. It has to wait for a key frame.
    void join(EncodedSink& sink);
    /// Removes a sink; no call to it is under way or comes later.
    void leave(EncodedSink& sink);
    /// Encodes the frame of a tick, unless another output has offered the tick already. Never
    /// waits: if the encoder cannot follow, the oldest waiting frame is left out for all sinks.
    void offer(const ColourImage& picture, std::uint64_t tick);
    /// Makes a coming frame a key frame, at most two per second.
    void request_key();
    /// Encodes what waits in the encoder if this is its only sink; to be called before it leaves.
    void flush_for(const EncodedSink& sink);
    /// Encodes all that waits. No frame may be offered any more.
    void flush();

    /// Number of frames that were encoded.
    std::uint64_t encoded() const { return encoded_; }
    /// Number of sinks.
    std::size_t sinks() const;

  private:
    struct Offer {
        ColourImage picture;
        std::uint64_t tick = 0;
    };
    void run();
    void encode(const Offer& offer);
    void flush_encoder();
    void pass_on();
    void fail_all(const std::string& sentence);

    const std::string encoder_name_;
    const EncoderSettings settings_;
    BoundedQueue<Offer> offers_;
    std::atomic<std::uint64_t> encoded_ = 0;
    std::atomic<bool> wants_key_ = false, wants_flush_ = false;

    std::mutex offer_mutex_;
    std::optional<std::uint64_t> offered_;  ///< newest tick; guarded by offer_mutex_

    std::mutex encoder_mutex_;  ///< held while a frame is encoded
    // Guarded by encoder_mutex_.
    std::optional<PictureEncoder> open_;
    int uses_ = 0;
    double encode_ms_ = 0;
    std::optional<std::uint64_t> last_key_tick_;

    mutable std::mutex sinks_mutex_;
    std::vector<EncodedSink*> sinks_;  ///< guarded by sinks_mutex_

    std::mutex thread_mutex_;
    std::thread thread_;  ///< guarded by thread_mutex_; begins with the first sink
};

/// The encoders of a programme, one for each kind and settings. Thread-safe.
class EncoderPool {
  public:
    /// The encoder with these settings. It lives as long as an output holds it.
    std::shared_ptr<SharedEncoder> find(const std::string& encoder,
                                        const EncoderSettings& settings);
    /// Encodes all that waits, after the last frame of the programme.
    void flush();
    /// Number of frames that these encoders have encoded.
    std::uint64_t encoded() const;

  private:
    mutable std::mutex mutex_;
    std::vector<std::weak_ptr<SharedEncoder>> encoders_;
};

}  // namespace vantage
