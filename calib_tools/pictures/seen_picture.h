#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/board/board_finder.h"

namespace vantage {

/// Image and the board that was detected in it.
struct SeenPicture {
    std::filesystem::path path;
    int width_px = 0, height_px = 0;
    GreyImage pixels;  ///< of a picture in memory; empty for a file, which is read when needed
    BoardSighting sighting;  ///< without corners, its reason says why
    double sharpness = 0;    ///< slope of its steepest edges, as a share of its contrast per pixel
    double saturated = 0;    ///< share of pixels with the highest value
    std::string name() const { return path.filename().string(); }
};

/// Reads the images and detects the board in each, on all cores, and logs the progress. Damaged
/// files, boards of another size, blur and glare become reasons, never exceptions. Blur is judged
/// relative to the sharper half of the series, since lenses differ.
std::vector<SeenPicture> look_at_pictures(const std::vector<std::filesystem::path>& files,
                                          const CalibrationBoards& boards);

/// The same for pictures that may be in memory already.
std::vector<SeenPicture> look_at_pictures(std::vector<SeenPicture> pictures,
                                          const CalibrationBoards& boards);

/// Detects the board in an image in memory, without judging blur and glare.
SeenPicture look_at_picture(const GreyImage& grey, const std::filesystem::path& path,
                            const CalibrationBoards& boards);

/// How the board in the images was printed; see BoardSighting.
struct PrintedBoard {
    bool inverted = false, legacy = false;
};
PrintedBoard printed_board_of(const std::vector<SeenPicture>& pictures);

/// Typical values of a series of images that show the board.
struct UsualPicture {
    double blur_px = 0, sharpness = 0, saturated = 0, burnt_out_share = 0;
};
UsualPicture usual_of(const std::vector<SeenPicture>& pictures);

/// Refuses an image with a board if it is blurred or has glare on the board, compared with the
/// typical values. For an image without a board, adds blur or glare to the reason if they may be
/// the cause.
void judge_blur_and_glare(SeenPicture& picture, const UsualPicture& usual);

/// Returns the most common image size; images of other sizes are refused with the reason.
void require_one_size(std::vector<SeenPicture>& pictures);

/// Refuses every image whose corners equal those of an earlier image exactly. A copied file would
/// count twice and make any lens look right on withheld views.
void refuse_repeated(std::vector<SeenPicture>& pictures);

/// Throws Error if most images show a board of one other size, or mirrored markers: one sentence
/// instead of a list of reasons.
void refuse_wrong_board(const std::vector<SeenPicture>& pictures, const CalibrationBoards& boards);

}  // namespace vantage
