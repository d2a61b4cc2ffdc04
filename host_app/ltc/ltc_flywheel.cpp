#include "host_app/ltc/ltc_flywheel.h"

#include <cstdlib>

namespace vantage {

std::optional<SmpteCode> LtcFlywheel::next(const std::optional<SmpteCode>& picture) {
    const std::optional<std::int64_t> shown = picture ? count_.frame_of(*picture) : std::nullopt;
    if (shown) {
        stood_ = shown == last_picture_ ? stood_ + 1 : 0;
        last_picture_ = shown;
        const std::int64_t second = count_.numbers_a_second;
        const bool is_elsewhere = next_ && std::abs(count_.between(*shown, *next_)) > second / 4;
        if (!next_ || is_elsewhere || stood_ >= second) {
            jumps_ += is_elsewhere && stood_ < second;
            next_ = shown;
        }
    }
    if (!next_) return std::nullopt;
    return count_.code_of((*next_)++);
}

}  // namespace vantage
