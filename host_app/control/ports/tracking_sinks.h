#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "common/base/latest_value.h"
#include "common/base/time/time.h"
#include "common/wire/wake_event.h"
#include "host_app/flight/camera_state.h"
#include "host_app/ltc/smpte_code.h"
#include "host_app/output/output_url.h"
#include "host_app/output/picture_sink.h"

namespace vantage {

/// The camera of one tick, for receivers of tracking data. Owns no memory.
struct CameraTick {
    std::uint64_t tick = 0;  ///< counts from 0
    MonotonicTime due{};     ///< when the tick was due
    CameraState camera;
    int width_px = 0, height_px = 0;    ///< of the picture
    std::optional<SmpteCode> timecode;  ///< empty: unknown
    std::optional<bool> ptp_locked;     ///< whether all rigs follow PTP; empty without rigs
};

/// Without time code and PTP.
CameraTick camera_tick_of(const ProgrammePicture& picture);

/// Sends the camera of every tick, at a constant rate even where the programme is late: a tick that
/// it has not handed over a quarter of a period after it was due is sent with the camera of the
/// tick before, as the picture is repeated. It gives up a second after the last one that was handed
/// over. All ticks are sent by a thread of its own, which has real-time priority where the system
/// grants it. The thread shares no lock with the programme, so neither the programme nor other
/// programs delay it.
class CameraPacer {
  public:
    /// `send` is called on the pacer's thread for one tick at a time, in order and once, from tick
    /// 0 on. It must not throw.
    CameraPacer(double rate_hz, std::function<void(const CameraTick&)> send);
    ~CameraPacer();
    CameraPacer(const CameraPacer&) = delete;
    CameraPacer& operator=(const CameraPacer&) = delete;

    /// Hands over a tick, to be sent at once unless that was done already. Never waits. One thread
    /// calls this.
    void take(const CameraTick& tick);
    /// Sends the last tick that was handed over, and nothing from then on.
    void stop();

  private:
    void run();
    void send_until(const CameraTick& newest);
    MonotonicTime due_of_next(const CameraTick& newest) const;
    void wait_until(std::optional<MonotonicTime> time) const;

    const double rate_hz_;
    const std::function<void(const CameraTick&)> send_;
    LatestValue<CameraTick> handed_;
    WakeEvent changed_;
    std::atomic<bool> is_stopped_ = false;
    std::uint64_t next_ = 0;  ///< tick to be sent; of the thread
    std::thread thread_;      ///< the last member: it uses the others
};

/// Creates the sender of tracking data for a URL: `freed://HOST:PORT` sends the camera of every
/// tick as a FreeD D1 message, whose number `camera=1` sets; `opentrackio://HOST:PORT` sends it as
/// an OpenTrackIO sample, with `opentrackio://multicast` to the group of the standard. Null for
/// another kind of URL. `rate_hz` is the programme's rate, `pulse_rate_hz` the stage's. Throws
/// Error if the URL is not valid.
std::unique_ptr<PictureSink> make_tracking_sink(const std::string& url, double rate_hz,
                                                double pulse_rate_hz);

constexpr int most_opentrackio_source = 200;
/// Nominal width of the virtual camera's sensor, and its limits for the option `sensor-mm`.
constexpr int usual_sensor_mm = 36, least_sensor_mm = 1, most_sensor_mm = 100;

/// The URL with the multicast group and the port of the standard for `opentrackio://multicast`:
/// 239.135.1.SOURCE:55555, with the option `source` (1 by default).
OutputUrl with_opentrackio_group(OutputUrl url);

}  // namespace vantage
