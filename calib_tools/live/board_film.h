#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "calib_tools/board/board_set.h"
#include "calib_tools/live/live_rigs.h"
#include "calib_tools/pictures/seen_picture.h"

namespace vantage {

/// A sensor whose pictures of the board are wanted.
struct FilmedCamera {
    std::size_t rig = 0;  ///< of LiveRigs
    bool is_left = true;
    std::string name;              ///< in sentences: "left", "A left"
    std::filesystem::path folder;  ///< keeps its pictures as left_PULSE.png or right_PULSE.png
};

/// What was kept of a live film: for every camera one picture an instant, which may be without a
/// sighting.
struct BoardFilm {
    std::vector<std::uint64_t> pulses;
    std::vector<std::vector<SeenPicture>> pictures;  ///< [camera][instant]
};

/// Why an instant cannot be used, as a sentence; empty if it can. The pictures are one of every
/// camera, judged by blur and glare already.
using FilmRule = std::function<std::string(const std::vector<SeenPicture>& pictures)>;

/// What is still missing of the film, a sentence each; the film is complete when nothing is.
using FilmAdvice = std::function<std::vector<std::string>(const BoardFilm& film)>;

/// Chooses pictures of the board from what running rigs see while somebody moves it: keeps an
/// instant that the rule takes and whose board stands at a new place, writes its pictures, and says
/// on the log what is missing or why an instant is no good. Ends when nothing is missing, when
/// `most` instants are kept, or when the program is asked to stop. Throws Error for folders that
/// hold pictures already, where rigs fall silent, and if the pictures show another board.
BoardFilm film_board(LiveRigs& rigs, const std::vector<FilmedCamera>& cameras,
                     const BoardSet& boards, std::size_t most, const FilmRule& rule,
                     const FilmAdvice& advice);

/// Every camera has to see the board.
std::string all_see_board(const std::vector<SeenPicture>& pictures);

/// What every camera's lens still needs (coverage, tilt, distance), by a calibration on the way.
FilmAdvice lens_advice(std::vector<std::string> camera_names);

/// At least two rigs have to see the board; cameras 2i and 2i + 1 are of rig i.
std::string two_rigs_see_board(const std::vector<SeenPicture>& pictures);

/// Which rigs are not tied to the others by enough instants yet.
FilmAdvice tie_advice(std::vector<std::string> rig_names);

}  // namespace vantage
