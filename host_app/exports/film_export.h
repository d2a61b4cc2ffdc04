#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/take/take_reader.h"
#include "host_app/exports/take_export.h"
#include "host_app/flight/moves/move.h"
#include "host_app/programme/view_painter.h"

namespace vantage {

/// The camera and time of one picture of a film.
struct FilmPicture {
    double pulse = 0;  ///< time in pulses of the take
    CameraState camera;
};

/// The pictures of a camera move over a part of a take at `rate_hz`. If the move defines the time
/// in the take, its own duration is the film's; otherwise the part plays at normal speed, and the
/// camera stays where the move ends. Throws Error if there are no pictures.
std::vector<FilmPicture> film_of(const Move& move, const TakeReader& take, const TakePart& part,
                                 double rate_hz);
/// The pictures of the camera that was recorded with the take. Throws Error if there are none.
std::vector<FilmPicture> film_of_cameras(const TakeReader& take, const TakePart& part,
                                         double rate_hz);

struct FilmSettings {
    PictureFormat format;
    double rate_hz = 30;
    std::string synthesiser;
    /// The film is rendered in parts of this length; an interruption loses the current part only.
    std::uint64_t part_pictures = 100;
};

/// Renders the pictures at the best quality level into a film (see VideoWriter), which appears when
/// it is complete. Until then its parts are in FILE.parts (see FilmParts), and an export of the
/// same take, pictures and settings resumes there. `is_wanted` is called before every picture and
/// while the background is learnt; false ends the export. The background is learnt from 20 s before
/// the first picture to render, and if the take has less, from after it. Throws Error if the file
/// exists.
ExportStats export_film(std::shared_ptr<const TakeReader> take,
                        const std::vector<FilmPicture>& pictures, const FilmSettings& settings,
                        const std::filesystem::path& file, const std::function<bool()>& is_wanted,
                        const std::function<void(double)>& progress = {});

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
