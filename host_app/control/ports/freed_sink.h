#pragma once

#include <memory>
#include <string>

#include "host_app/output/picture_sink.h"

namespace vantage {

/// FreeD sender: sends the camera of every tick as a D1 message to `freed://HOST:PORT`; `camera=1`
/// sets its number.
bool is_freed_url(const std::string& url);
/// `rate_hz` is that of the programme. Throws Error if the URL is not valid.
std::unique_ptr<PictureSink> make_freed_sink(const std::string& url, double rate_hz);

}  // namespace vantage
