#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "common/av/sound.h"
#include "host_app/ltc/smpte_code.h"

struct LTCDecoder;

namespace vantage {

/// A frame of linear time code that was heard.
struct LtcReading {
    SmpteCode code;
    std::int64_t first = 0;      ///< sample at which it begins
    double frames_a_second = 0;  ///< by its length
};

/// Finds linear time code in sound, by libltc. A code is believed where it follows the one before
/// it; what is none, or jumps, is counted.
class LtcReader {
  public:
    LtcReader();

    /// What ended in this block, which begins where the last one ended or later.
    std::vector<LtcReading> hear(const SoundBlock& sound);

    std::uint64_t malformed() const { return malformed_; }

  private:
    struct Deleter {
        void operator()(LTCDecoder* decoder) const;
    };
    std::unique_ptr<LTCDecoder, Deleter> decoder_;
    std::optional<LtcReading> last_;  ///< that was well formed
    std::uint64_t malformed_ = 0;
};

/// What code of this rate counts: 24, 25 or 30 numbers a second.
SmpteCount count_of(const LtcReading& reading);

}  // namespace vantage
