#pragma once

#include <string>

#include "host_app/output/output_url.h"

namespace vantage {

constexpr int most_opentrackio_source = 200;
/// Nominal width of the virtual camera's sensor, and its limits for the option `sensor-mm`.
constexpr int usual_sensor_mm = 36, least_sensor_mm = 1, most_sensor_mm = 100;

/// The URL with the multicast group and the port of the standard for `opentrackio://multicast`:
/// 239.135.1.SOURCE:55555, with the option `source` (1 by default).
inline OutputUrl with_opentrackio_group(OutputUrl url) {
    if (url.place == "multicast")
        url.place = "239.135.1." +
                    std::to_string(url.number("source", 1, most_opentrackio_source).value_or(1)) +
                    ":55555";
    return url;
}

}  // namespace vantage
