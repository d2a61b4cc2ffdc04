#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "common/base/time/time.h"
#include "host_app/output/picture_sink.h"

namespace vantage {

/// The camera of one tick, for receivers of tracking data.
struct CameraTick {
    std::uint64_t tick = 0;
    CameraState camera;
    std::shared_ptr<const FrameSet> set;
    int width_px = 0, height_px = 0;  ///< of the picture
};

/// Sends the camera of every tick, at a constant rate even where the programme is late: a tick that
/// it has not handed over a quarter of a period after it was due is sent with the camera of the
/// tick before, as the picture is repeated. A thread of its own waits for such ticks, from the
/// second tick on, and gives up a second after the last one that was handed over. Where the system
/// grants it real-time priority, it sends all ticks, so that neither the programme nor other
/// programs delay them.
class CameraPacer {
  public:
    /// `send` is called for one tick at a time, in order and once, by the caller of take() or by
    /// the pacer's thread. It must not throw.
    CameraPacer(double rate_hz, std::function<void(const CameraTick&)> send);
    ~CameraPacer();
    CameraPacer(const CameraPacer&) = delete;
    CameraPacer& operator=(const CameraPacer&) = delete;

    /// Sends the tick, or has the thread send it, unless that was done already.
    void take(const ProgrammePicture& picture);
    /// Sends nothing from now on.
    void stop();

  private:
    void run();
    void send_newest();
    MonotonicTime time_of(std::uint64_t tick) const;

    const double rate_hz_;
    const std::function<void(const CameraTick&)> send_;
    std::mutex mutex_;  ///< guards all below
    std::condition_variable changed_;
    std::optional<CameraTick> newest_;  ///< empty: none was taken
    std::uint64_t next_ = 0;            ///< tick to be sent
    /// When tick 0 was due, by the tick that came earliest after its time.
    MonotonicTime start_{};
    MonotonicTime taken_{};   ///< when the newest was taken
    bool is_prompt_ = false;  ///< the thread has real-time priority
    bool is_stopped_ = false;
    std::thread thread_;  ///< started by the second tick
};

}  // namespace vantage
