#pragma once

#include <memory>
#include <optional>
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
    LtcReader();

    /// Returns the codes that ended in this block, which starts at or after the end of the last
    /// one.
    std::vector<LtcReading> hear(const SoundBlock& sound);

    std::uint64_t malformed() const { return malformed_; }

  private:
    struct Deleter {
        void operator()(LTCDecoder* decoder) const;
    };
    std::unique_ptr<LTCDecoder, Deleter> decoder_;
    std::optional<LtcReading> last_;  ///< last valid one
    std::uint64_t malformed_ = 0;
};

/// The count of a code's rate: 24, 25 or 30 per second.
SmpteCount count_of(const LtcReading& reading);

}  // namespace vantage
