#pragma once

#include <memory>
#include <vector>

#include "host_app/ltc/smpte_code.h"

struct LTCEncoder;

namespace vantage {

/// Time code as sound (SMPTE ST 12-1 linear time code), frame by frame, at 48000 samples a second
/// and -12 dB, by libltc.
class LtcWriter {
  public:
    /// `rate_hz`: 24, 25, 29.97 (drop-frame) or 30. Throws Error if memory is short.
    explicit LtcWriter(double rate_hz);

    /// The next frame: one channel. Of 29.97 a second 1601 and 1602 samples in turn.
    std::vector<float> frame(const SmpteCode& code);

  private:
    struct Deleter {
        void operator()(LTCEncoder* encoder) const;
    };
    std::unique_ptr<LTCEncoder, Deleter> encoder_;
};

}  // namespace vantage
