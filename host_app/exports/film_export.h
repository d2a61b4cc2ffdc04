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

/// A picture of a film: from where, and of what.
struct FilmPicture {
    double pulse = 0;  ///< of the newest that is not later
    CameraState camera;
};

/// The pictures of a move over a part of a take, `rate_hz` a second. A move that says where in the
/// take it is gives all of them, its time being the film's; over any other the part goes at normal
/// speed, and the camera stays where the move ends. Throws Error where there is none of them.
std::vector<FilmPicture> film_of(const Move& move, const TakeReader& take, const TakePart& part,
                                 double rate_hz);
/// Those of the camera that the take was flown with. Throws Error likewise.
std::vector<FilmPicture> film_of_cameras(const TakeReader& take, const TakePart& part,
                                         double rate_hz);

struct FilmSettings {
    PictureFormat format;
    double rate_hz = 30;
    std::string synthesiser;
    /// That one is rendered after the other; what is killed loses the part that it is at.
    std::uint64_t part_pictures = 100;
};

/// Renders them at the best level, however long that takes, into a film (see VideoWriter) that is
/// there when it is whole; until then its parts are in FILE.parts (see FilmParts), where a film of
/// the same take, pictures and settings goes on. `is_wanted` is asked before every picture, and
/// while the set is learnt; one that is not wanted any more is left there. The set is learnt from
/// twenty seconds before the first picture, or the one that it goes on with, and where the take has
/// fewer from those after it. Throws Error if there is such a file already.
ExportStats export_film(std::shared_ptr<const TakeReader> take,
                        const std::vector<FilmPicture>& pictures, const FilmSettings& settings,
                        const std::filesystem::path& file, const std::function<bool()>& is_wanted,
                        const std::function<void(double)>& progress = {});

}  // namespace vantage
