#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "common/av/sound.h"

namespace vantage {

enum class SoundPhase {
    opening,
    on,
    failed,  ///< `failure` says why; a device is tried again
    ended,   ///< a file, at its end
};

/// How the programme's sound stands. Counts are of samples.
struct SoundState {
    std::string name;
    SoundPhase phase = SoundPhase::opening;
    std::string failure;  ///< empty: none now
    std::uint64_t failures = 0;
    std::uint64_t heard = 0;  ///< that came
    std::uint64_t lost =
        0;  ///< that did not come in time to be heard, in place of which is silence
    std::uint64_t dropped = 0;   ///< that came faster than time goes
    std::uint64_t inserted = 0;  ///< to keep pace with a programme whose clock is faster...
    std::uint64_t removed = 0;   ///< ...or slower than the device's
    double drift_ppm = 0;        ///< of the device's clock, ahead of this computer's

    double peak_dbfs = -120;    ///< of what goes with the programme now; 0 is the most
    double delay_ms = 0;        ///< from being heard to leaving with its picture
    std::uint64_t played = 0;   ///< that went with the programme
    std::uint64_t missing = 0;  ///< of those, silent since they were not there
    std::uint64_t slid = 0;     ///< put in or taken out to follow the picture's delay
    std::uint64_t jumps = 0;    ///< over what could not be slid over
};

/// For machines, such as "on".
const char* key_of(SoundPhase phase);

/// Takes sound as it comes: never waits.
using SoundTap = std::function<void(const SoundBlock&)>;

/// Where the programme's sound comes from. Thread-safe.
class SoundSource {
  public:
    virtual ~SoundSource() = default;
    /// From sample `first` on; what is not there is silent. How many were there. Never waits.
    virtual std::size_t read(std::int64_t first, std::span<float> samples) = 0;
    /// Samples are counted from the programme's first tick on, not by when they were heard.
    virtual bool goes_with_ticks() const { return false; }
    virtual SoundState state() const = 0;
};

/// What `--audio` names: `alsa:NAME` or a file. What comes from a device goes to `tap` too. Throws
/// Error for what is neither, or a file without sound; a device that is missing is waited for.
std::shared_ptr<SoundSource> open_sound(const std::string& url, SoundTap tap);
/// Throws Error as that would, and opens no device.
void check_sound(const std::string& url);

}  // namespace vantage
