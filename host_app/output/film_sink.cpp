#include "host_app/output/film_sink.h"

#include <cmath>

namespace vantage {

void FilmSink::take(const ProgrammePicture& picture) {
    recorder_.add(
        picture.picture,
        std::chrono::nanoseconds(std::llround(1e9 * static_cast<double>(picture.tick) / rate_hz_)));
}

}  // namespace vantage
