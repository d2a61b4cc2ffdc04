#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/av/sound.h"
#include "host_app/ltc/smpte_code.h"

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

}  // namespace vantage
