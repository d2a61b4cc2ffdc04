#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "calib_tools/board/calibration_boards.h"
#include "calib_tools/live/live_rigs.h"
#include "calib_tools/pictures/seen_picture.h"
#include "common/base/error.h"

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
    /// How many instants are kept, where, and how to go on, as the end of a sentence.
    std::string kept;
};

/// Why an instant cannot be used, as a sentence; empty if it can. The pictures are one of every
/// camera, judged by blur and glare already.
using FilmRule = std::function<std::string(const std::vector<SeenPicture>& pictures)>;

/// What is still missing of the film, a sentence each; the film is complete when nothing is.
using FilmAdvice = std::function<std::vector<std::string>(const BoardFilm& film)>;

struct FilmOptions {
    std::size_t most = 40;  ///< instants
    bool go_on = false;     ///< the folders' pictures are those of a film that was ended before
};

/// Chooses pictures of the board from what running rigs see while somebody moves it: keeps an
/// instant that the rule takes and whose board stands at a new place, writes its pictures, and says
/// on the log what is missing or why an instant is no good. Ends when nothing is missing, when
/// `most` instants are kept, or when the program is asked to stop. Throws Error for folders that
/// hold pictures already (unless it goes on from them), where rigs fall silent, and if the pictures
/// show another board; it says then what is kept.
BoardFilm film_board(LiveRigs& rigs, const std::vector<FilmedCamera>& cameras,
                     const CalibrationBoards& boards, const FilmOptions& options,
                     const FilmRule& rule, const FilmAdvice& advice);

/// Does what follows a film; if that throws Error, so does this, saying also what is kept. `kept`
/// is empty where nothing was filmed.
template <class Action>
auto with_kept_film(const std::string& kept, const Action& action) {
    try {
        return action();
    } catch (const Error& error) {
        if (kept.empty()) throw;
        fail("{}; {}", error.what(), kept);
    }
}

/// Every camera has to see the board.
std::string all_see_board(const std::vector<SeenPicture>& pictures);

/// What every camera's lens still needs (coverage, tilt, distance), by a calibration on the way.
FilmAdvice lens_advice(std::vector<std::string> camera_names);

/// At least two rigs have to see one board or body; cameras 2i and 2i + 1 are of rig i.
FilmRule two_rigs_see_board(const CalibrationBoards& boards);

/// The same, and the first instant has to show the board that lies on the floor: the one that is
/// named, or, without a name, one board only that is no part of a body.
FilmRule floor_first(const CalibrationBoards& boards, std::string floor_board);

/// Which rigs are not tied to the others by enough instants yet.
FilmAdvice tie_advice(const CalibrationBoards& boards, std::vector<std::string> rig_names);

}  // namespace vantage
