#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "common/av/sound.h"
#include "common/take/take_reader.h"

namespace vantage {

struct OutputUrl;

enum class SoundPhase {
    opening,
    on,
    failed,  ///< `failure` has the reason; a device is tried again
    ended,   ///< a file reached its end
};

/// The state of the programme's sound. Counts are in samples.
struct SoundState {
    std::string name;
    SoundPhase phase = SoundPhase::opening;
    std::string failure;  ///< empty: none
    std::uint64_t failures = 0;
    std::uint64_t heard = 0;     ///< received from the source
    std::uint64_t lost = 0;      ///< came too late and are silent
    std::uint64_t dropped = 0;   ///< came faster than real time
    std::uint64_t inserted = 0;  ///< where the device's clock is slower than the programme's...
    std::uint64_t removed = 0;   ///< ...or faster
    double drift_ppm = 0;        ///< how fast the device's clock is relative to this computer's

    double peak_dbfs = -120;    ///< current level of the programme; 0 is full scale
    double delay_ms = 0;        ///< from being heard to output with its picture
    std::uint64_t played = 0;   ///< output with the programme
    std::uint64_t missing = 0;  ///< of those, silent because they were missing
    std::uint64_t slid = 0;     ///< inserted or removed to follow the pictures' delay
    std::uint64_t jumps = 0;    ///< number of jumps
};

/// For JSON: "on" etc.
const char* key_of(SoundPhase phase);

/// Receives sound as it comes; must not block.
using SoundTap = std::function<void(const SoundBlock&)>;

/// The source of the programme's sound. Thread-safe.
class SoundSource {
  public:
    virtual ~SoundSource() = default;
    /// Copies from sample `first`; missing samples are silent. Returns the number of found ones.
    /// Never waits.
    virtual std::size_t read(std::int64_t first, std::span<float> samples) = 0;
    /// Whether samples are counted from the programme's first tick instead of from the TAI epoch.
    virtual bool goes_with_ticks() const { return false; }
    virtual SoundState state() const = 0;
};

/// Opens the argument of `--audio`: `alsa:NAME` or a file. A device's sound also goes to `tap`.
/// Throws Error for an unknown source or a file without sound; a missing device is waited for.
std::shared_ptr<SoundSource> open_sound(const std::string& url, SoundTap tap);
/// Throws the same Error without opening a device.
void check_sound(const std::string& url);

/// Opens an ALSA device, with `channels=3,4` for some of its channels. A missing or unplugged
/// device is silent, is logged, and is tried again until it is there. Throws Error for invalid
/// options.
std::shared_ptr<SoundSource> open_alsa_sound(const OutputUrl& url, SoundTap tap);
/// Throws the same Error without opening the device.
void check_alsa_sound(const OutputUrl& url);

/// Opens a sound file that starts with the programme's first tick; `loop=yes` repeats it. Throws
/// Error if the file has no sound.
std::shared_ptr<SoundSource> open_file_sound(const OutputUrl& url);

/// Opens the sound of a take, addressed by the time at which it was heard. Precondition: the take
/// has sound. Reads some seconds ahead on a thread of its own, from `begin`, for a programme that
/// never waits.
std::shared_ptr<SoundSource> open_take_sound(std::shared_ptr<const TakeReader> take, TaiTime begin);
/// Opens it for reading on request, for film exports, which may wait.
std::shared_ptr<SoundSource> open_patient_take_sound(std::shared_ptr<const TakeReader> take);

/// A ring of the latest sound, addressed by sample number. One thread writes, others read, under a
/// lock held for a copy only.
class SoundRing {
  public:
    /// Precondition: capacity > 0, in samples.
    explicit SoundRing(std::size_t capacity);

    /// Writes the next samples. A gap before them becomes silence; samples that are there already
    /// stay. Returns the number of new samples.
    std::size_t write(std::int64_t first, std::span<const float> samples);
    /// Copies from sample `first`; missing samples are silent. Returns the number of found ones.
    std::size_t read(std::int64_t first, std::span<float> samples) const;
    /// Clears the ring; `first` is the next sample.
    void begin_at(std::int64_t first);

    std::int64_t begin() const;
    std::int64_t end() const;

  private:
    std::size_t place_of(std::int64_t sample) const;
    void put(std::int64_t first, std::span<const float> samples);

    mutable std::mutex mutex_;
    std::vector<float> samples_;
    std::int64_t capacity_, begin_ = 0, end_ = 0;
};

/// Reads and decodes sound on a thread of its own, some seconds before it is requested, so that
/// read() never waits. After a jump it is silent until the sound there has been read.
class SoundAhead {
  public:
    /// Fetches up to `count` samples from `first`; fewer mean the end of the sound. Called by one
    /// thread. An exception ends the reading.
    using Fetch = std::function<std::vector<float>(std::int64_t first, std::size_t count)>;
    /// Fetches the first part before it returns. Throws what `fetch` throws.
    SoundAhead(Fetch fetch, std::int64_t first);
    ~SoundAhead();
    SoundAhead(const SoundAhead&) = delete;
    SoundAhead& operator=(const SoundAhead&) = delete;

    /// See SoundSource::read().
    std::size_t read(std::int64_t first, std::span<float> samples);
    struct State {
        std::string failure;  ///< why reading ended; empty: no failure
        std::uint64_t fetched = 0;
        bool is_at_end = false;  ///< whether all sound was read
    };
    State state() const;

  private:
    /// Fetches one part; false: enough is there for now.
    bool fetch_some(std::int64_t wanted);
    void run();

    Fetch fetch_;
    SoundRing ring_;
    std::int64_t next_;  ///< used by the thread only
    mutable std::mutex mutex_;
    std::condition_variable woken_;
    std::int64_t wanted_;
    bool is_ending_ = false;
    State state_;
    std::thread thread_;
};

}  // namespace vantage
