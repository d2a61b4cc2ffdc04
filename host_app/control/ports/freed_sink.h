#pragma once

#include <memory>
#include <string>

#include "host_app/output/picture_sink.h"

namespace vantage {

/// Sends the camera of every tick as FreeD D1: `freed://HOST:PORT`, with `camera=1` for its number.
bool is_freed_url(const std::string& url);
/// Throws Error for what is no such place.
std::unique_ptr<PictureSink> make_freed_sink(const std::string& url);

}  // namespace vantage
