#pragma once

#include <memory>
#include <vector>

#include "common/take/take_reader.h"
#include "host_app/exports/film_export.h"

namespace vantage {

/// The sound of each picture of a film over a take: what was heard at its pulse, while pictures
/// advance at normal speed for half a second around it; otherwise silence. Continuous where
/// pictures repeat a pulse. Empty if the take has no sound.
std::vector<std::shared_ptr<const SoundBlock>> sound_of_film(
    const std::shared_ptr<const TakeReader>& take, const std::vector<FilmPicture>& pictures,
    double rate_hz);

/// The time of each picture that advances at normal speed; empty for the others.
std::vector<std::optional<TaiTime>> even_times(const std::vector<FilmPicture>& pictures,
                                               double rate_hz, double pulse_rate_hz);

}  // namespace vantage
