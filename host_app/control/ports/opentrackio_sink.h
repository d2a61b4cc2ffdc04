#pragma once

#include <memory>
#include <string>

#include "host_app/output/picture_sink.h"

namespace vantage {

/// OpenTrackIO sender: sends the camera of every tick to `opentrackio://HOST:PORT`, or with
/// `opentrackio://multicast` to the group of the standard.
bool is_opentrackio_url(const std::string& url);
/// `rate_hz` is that of the programme, `pulse_rate_hz` that of the stage. Throws Error if the URL
/// is not valid.
std::unique_ptr<PictureSink> make_opentrackio_sink(const std::string& url, double rate_hz,
                                                   double pulse_rate_hz);

}  // namespace vantage
