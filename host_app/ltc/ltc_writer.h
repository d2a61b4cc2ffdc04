#pragma once

#include <memory>
#include <vector>

#include "host_app/ltc/smpte_code.h"

struct LTCEncoder;

namespace vantage {

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

}  // namespace vantage
