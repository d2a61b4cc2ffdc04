#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "calib_tools/live/live_rigs.h"
#include "calib_tools/pictures/seen_picture.h"
#include "common/base/error.h"
#include "common/board/calibration_boards.h"

namespace vantage {

/// Camera that films the board.
struct FilmedCamera {
    std::size_t rig = 0;  ///< index in LiveRigs
    bool is_left = true;
    std::string name;              ///< name in sentences: "left", "A left"
    std::filesystem::path folder;  ///< where images are saved as left_PULSE.png or right_PULSE.png
};

/// Images kept of a live film: one image per camera and frame set, possibly without a sighting.
struct BoardFilm {
    std::vector<std::uint64_t> pulses;
    std::vector<std::vector<SeenPicture>> pictures;  ///< [camera][frame set]
    /// Sentence ending with the number of frame sets kept, their folder, and how to continue.
    std::string kept;
};

/// Returns the reason, as a sentence, why a frame set cannot be used; empty if it can. It gets one
/// image per camera, already judged for blur and glare.
using FilmRule = std::function<std::string(const std::vector<SeenPicture>& pictures)>;

/// Returns one sentence for everything that the film still lacks; empty if it is complete.
using FilmAdvice = std::function<std::vector<std::string>(const BoardFilm& film)>;

struct FilmOptions {
    std::size_t most = 40;  ///< in frame sets
    bool go_on = false;     ///< continue an earlier film with the images in the folders
};

/// Films the board with running rigs while somebody moves it. It keeps a frame set if `rule`
/// accepts it and the board is at a new position, writes its images, and logs what is missing or
/// why a frame set was refused. It ends when nothing is missing, when `most` frame sets are kept,
/// or when the program is asked to stop. Throws Error if a folder already holds images (unless it
/// continues from them), if rigs stop sending, and if the images show another board; the message
/// says what is kept.
BoardFilm film_board(LiveRigs& rigs, const std::vector<FilmedCamera>& cameras,
                     const CalibrationBoards& boards, const FilmOptions& options,
                     const FilmRule& rule, const FilmAdvice& advice);

/// Runs the action that follows a film. If it throws Error, the new Error also says which images
/// are kept. `kept` is empty if nothing was filmed.
template <class Action>
auto with_kept_film(const std::string& kept, const Action& action) {
    try {
        return action();
    } catch (const Error& error) {
        if (kept.empty()) throw;
        fail("{}; {}", error.what(), kept);
    }
}

/// Rule: every camera has to see the board.
std::string all_see_board(const std::vector<SeenPicture>& pictures);

/// Lists what every camera's lens still needs (coverage, tilt, distance), from a provisional
/// calibration.
FilmAdvice lens_advice(std::vector<std::string> camera_names);

/// Rule: at least two rigs have to see one board or body. Cameras 2i and 2i + 1 belong to rig i.
FilmRule two_rigs_see_board(const CalibrationBoards& boards);

/// The same rule; in addition the first frame set has to show the board on the floor: the named
/// one, or, without a name, exactly one board that belongs to no body.
FilmRule floor_first(const CalibrationBoards& boards, std::string floor_board);

/// Lists the rigs that too few frame sets connect to the others.
FilmAdvice tie_advice(const CalibrationBoards& boards, std::vector<std::string> rig_names);

}  // namespace vantage
