#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/av/sound.h"
#include "host_app/ltc/smpte_code.h"

struct LTCEncoder;
struct LTCDecoder;

namespace vantage {

/// A decoded frame of linear time code.
struct LtcReading {
    SmpteCode code;
    std::int64_t first = 0;      ///< sample at which it begins
    double frames_a_second = 0;  ///< measured from its length
};

/// Decodes linear time code in sound, by libltc. A code is accepted if it follows the previous one;
/// invalid codes and jumps are counted. Not thread-safe.
class LtcReader {
  public:
    /// `rate_hz`: of the sound. Throws Error if memory runs out.
    explicit LtcReader(int rate_hz = sound_rate_hz);

    /// Returns the codes that ended in this sound of one channel, which starts at or after the end
    /// of the last call's. `first` numbers its first sample.
    std::vector<LtcReading> hear(std::span<const float> channel, std::int64_t first);
    /// Does the same for the left channel of a block.
    std::vector<LtcReading> hear(const SoundBlock& sound);

    std::uint64_t malformed() const { return malformed_; }

  private:
    struct Deleter {
        void operator()(LTCDecoder* decoder) const;
    };
    int rate_hz_;
    std::unique_ptr<LTCDecoder, Deleter> decoder_;
    std::optional<LtcReading> last_;  ///< last valid one
    std::uint64_t malformed_ = 0;
};

/// The count of a code's rate: 24, 25 or 30 per second.
SmpteCount count_of(const LtcReading& reading);

/// Generates SMPTE ST 12-1 linear time code as sound at 48000 samples per second and -12 dB, by
/// libltc. Not thread-safe.
class LtcWriter {
  public:
    /// `rate_hz`: 24, 25, 29.97 (drop-frame) or 30. Throws Error if memory runs out.
    explicit LtcWriter(double rate_hz);

    /// The mono sound of the next frame; 1601 and 1602 samples in turn at 29.97.
    std::vector<float> frame(const SmpteCode& code);

  private:
    struct Deleter {
        void operator()(LTCEncoder* encoder) const;
    };
    std::unique_ptr<LTCEncoder, Deleter> encoder_;
};

/// Generates the code of every frame of a programme's linear time code. It counts on by itself,
/// since receivers cannot follow repeated or late pictures, and jumps to the pictures' code if that
/// differs by more than a quarter of a second or stands still for as long.
class LtcFlywheel {
  public:
    explicit LtcFlywheel(SmpteCount count) : count_(count) {}

    /// The code of the next frame. `picture`: the code of its picture; empty: it has none. Returns
    /// nothing until the first picture with a code.
    std::optional<SmpteCode> next(const std::optional<SmpteCode>& picture);
    std::uint64_t jumps() const { return jumps_; }

  private:
    SmpteCount count_;
    std::optional<std::int64_t> next_, last_picture_;
    std::int64_t stood_ = 0;  ///< frames since the picture's code last changed
    std::uint64_t jumps_ = 0;
};

}  // namespace vantage
