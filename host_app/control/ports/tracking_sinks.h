#pragma once

#include <memory>
#include <string>

#include "host_app/output/output_url.h"
#include "host_app/output/picture_sink.h"

namespace vantage {

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
