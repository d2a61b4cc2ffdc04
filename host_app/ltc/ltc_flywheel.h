#pragma once

#include <optional>
#include <string>

#include "host_app/ltc/smpte_code.h"

namespace vantage {

/// The code of every frame of a programme's linear time code: it counts on by itself, since those
/// who listen cannot follow a picture that is repeated or a little late, and follows the pictures'
/// code where that is elsewhere by more than a quarter of a second, or stands for one.
class LtcFlywheel {
  public:
    explicit LtcFlywheel(SmpteCount count) : count_(count) {}

    /// Of the next frame. `picture`: the code of its picture, counted likewise; nothing: it has
    /// none. Nothing: there was none yet.
    std::optional<SmpteCode> next(const std::optional<SmpteCode>& picture);
    std::uint64_t jumps() const { return jumps_; }

  private:
    SmpteCount count_;
    std::optional<std::int64_t> next_, last_picture_;
    std::int64_t stood_ = 0;  ///< frames for which the picture's code was the same
    std::uint64_t jumps_ = 0;
};

}  // namespace vantage
