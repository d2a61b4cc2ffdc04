#pragma once

#include <memory>
#include <vector>

#include "common/take/take_reader.h"
#include "host_app/exports/film_export.h"

namespace vantage {

/// The sound of every picture of a film over a take: what was heard at its pulse, where pictures go
/// on as it was for half a second around; silence where time stands or goes another way. Without a
/// break where pictures repeat a pulse. Empty: the take has no sound.
std::vector<std::shared_ptr<const SoundBlock>> sound_of_film(
    const std::shared_ptr<const TakeReader>& take, const std::vector<FilmPicture>& pictures,
    double rate_hz);

/// The time of every picture that goes on as it was; nothing for the others.
std::vector<std::optional<TaiTime>> even_times(const std::vector<FilmPicture>& pictures,
                                               double rate_hz, double pulse_rate_hz);

}  // namespace vantage
