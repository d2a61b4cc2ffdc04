#include "rig_firmware/stereo/match_limits.h"

#include "common/base/error.h"
#include "common/gl/context/limits.h"

namespace vantage {

void require_match_limits(const MatchSettings& settings) {
    constexpr int smallest_side_px = 16, most_disparities = 256;
    if (settings.width_px < smallest_side_px || settings.height_px < smallest_side_px ||
        settings.width_px > PiLimits::max_image_side_px ||
        settings.height_px > PiLimits::max_image_side_px)
        fail(
            "a pair of {}x{} cannot be matched: each side must be {} to {} pixels, so scale or "
            "crop it",
            settings.width_px, settings.height_px, smallest_side_px, PiLimits::max_image_side_px);
    if (settings.disparities < 1 || settings.disparities > most_disparities)
        fail(
            "a search range of {} disparities is not possible: give 1 to {}, or halve the pictures",
            settings.disparities, most_disparities);
}

}  // namespace vantage
