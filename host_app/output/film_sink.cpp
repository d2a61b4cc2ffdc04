#include "host_app/output/film_sink.h"

#include <cmath>

#include "common/base/pulse_grid.h"

namespace vantage {
namespace {

constexpr double most_numbers_a_second = 60;

}  // namespace

FilmSink::FilmSink(const std::filesystem::path& path, const VideoSettings& settings,
                   double pulse_rate_hz)
    : path_(path), rate_hz_(PulseGrid(settings.rate_hz).rate_hz()), recorder_(path, settings) {
    if (rate_hz_ <= most_numbers_a_second) timecode_.emplace(pulse_rate_hz, settings.rate_hz);
}

void FilmSink::take(const ProgrammePicture& picture) {
    if (timecode_ && picture.set) {
        begins_at_ = timecode_->of(*picture.set);
        timecode_.reset();
    }
    recorder_.add(
        picture.picture,
        std::chrono::nanoseconds(std::llround(1e9 * static_cast<double>(picture.tick) / rate_hz_)),
        begins_at_);
}

}  // namespace vantage
