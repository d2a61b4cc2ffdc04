#include "host_app/exports/film_sound.h"

#include <algorithm>
#include <cmath>

#include "common/base/time/pulse_grid.h"
#include "host_app/sound/picture_sound.h"
#include "host_app/sound/take_sound.h"

namespace vantage {
namespace {

/// Whether pictures around one advance by as many pulses as at normal speed.
bool is_at_normal_speed(const std::vector<FilmPicture>& pictures, std::size_t at,
                        std::size_t around, double pulses_a_picture) {
    const std::size_t first = at - std::min(at, around);
    const std::size_t last = std::min(at + around, pictures.size() - 1);
    const double due = pulses_a_picture * static_cast<double>(last - first);
    // A picture shows the newest pulse, so either end may be off by one.
    return std::abs(pictures[last].pulse - pictures[first].pulse - due) <=
           std::max(1.01, 0.05 * due);
}

}  // namespace

std::vector<std::optional<TaiTime>> even_times(const std::vector<FilmPicture>& pictures,
                                               double rate_hz, double pulse_rate_hz) {
    const double pulses_a_picture = pulse_rate_hz / rate_hz;
    const auto around =
        static_cast<std::size_t>(std::ceil(std::max(rate_hz / 2, 3 / pulses_a_picture)));
    const PulseGrid pulses(pulse_rate_hz);
    std::vector<std::optional<TaiTime>> times(pictures.size());
    for (std::size_t begin = 0; begin < pictures.size();) {
        std::size_t end = begin;
    // The smallest delay of the run's first picture behind its pulse.
        double first = pictures[begin].pulse;
        while (end < pictures.size() &&
               is_at_normal_speed(pictures, end, around, pulses_a_picture)) {
            first = std::max(
                first, pictures[end].pulse - pulses_a_picture * static_cast<double>(end - begin));
            ++end;
        }
        const double whole = std::floor(first);
        const TaiTime start = pulses.time_of(static_cast<std::uint64_t>(whole)) +
                              from_s((first - whole) / pulse_rate_hz);
        for (std::size_t i = begin; i < end; ++i)
            times[i] = start + from_s(static_cast<double>(i - begin) / rate_hz);
        begin = std::max(end, begin + 1);
    }
    return times;
}

std::vector<std::shared_ptr<const SoundBlock>> sound_of_film(
    const std::shared_ptr<const TakeReader>& take, const std::vector<FilmPicture>& pictures,
    double rate_hz) {
    std::vector<std::shared_ptr<const SoundBlock>> blocks;
    if (!take->facts().has_sound) return blocks;
    PictureSound sound({.rate_hz = rate_hz, .delay = std::chrono::nanoseconds(0), .tap = {}},
                       open_patient_take_sound(take));
    for (const std::optional<TaiTime>& time :
         even_times(pictures, rate_hz, take->facts().pulse_rate_hz))
        blocks.push_back(sound.next({TaiTime(), time}));
    return blocks;
}

}  // namespace vantage
