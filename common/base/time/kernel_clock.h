#pragma once

namespace vantage {

/// What the kernel says of this computer's own clock.
struct KernelClock {
    int tai_offset_s = 0;          ///< of CLOCK_TAI from CLOCK_REALTIME
    bool is_synchronized = false;  ///< some daemon said so, and not too long ago (STA_UNSYNC)
    bool was_set_lately = false;   ///< some daemon trims it, and did within the last ten seconds
};

KernelClock read_kernel_clock();

}  // namespace vantage
