#pragma once

#include <iosfwd>

#include "common/take/take_reader.h"

namespace vantage {

/// Serves decoded frame sets of a take to another program on this computer, without copies of the
/// pixels: the decoders write into shared memory, which that program maps.
///
/// The first line on `out` describes the take as JSON. Each request is a line on `in`:
/// `{"pulse": N}` for a frame set, or `{"cameras": true}` for the camera of every tick. Each answer
/// is a line on `out`: either `{"error": SENTENCE}`, or an object with `fd`, the descriptor of the
/// shared memory in this process, its `bytes`, its number `memory`, and the place and shape of
/// every array in it. The descriptor is valid until the next request, and a mapping of it as long
/// as it is held. A request with `"released": [NUMBER...]` says which memory is no longer mapped,
/// so that it can be used again. Returns at the end of `in`. Throws Error if the take's head is
/// damaged.
void serve_take(const TakeReader& take, std::istream& in, std::ostream& out);

}  // namespace vantage
