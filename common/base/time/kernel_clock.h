#pragma once

namespace vantage {

/// The state of this computer's system clock, as the kernel reports it.
struct KernelClock {
    int tai_offset_s = 0;          ///< CLOCK_TAI minus CLOCK_REALTIME
    bool is_synchronized = false;  ///< a daemon reported it within its time limit (STA_UNSYNC)
    bool was_set_lately = false;   ///< a daemon trimmed the clock within the last 10 s
};

KernelClock read_kernel_clock();

}  // namespace vantage
