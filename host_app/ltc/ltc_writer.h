#pragma once

#include <memory>
#include <optional>
#include <string>
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
