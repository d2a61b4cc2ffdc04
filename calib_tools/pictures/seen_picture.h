#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calib_tools/board/board_finder.h"

namespace vantage {

/// A picture and what was found of the board in it.
struct SeenPicture {
    std::filesystem::path path;
    int width_px = 0, height_px = 0;
    BoardSighting sighting;  ///< without corners: its reason says why, whatever it is
    double sharpness = 0;    ///< slope of its steepest edges, of its contrast per pixel
    double saturated = 0;    ///< share of pixels at the top of the range
    std::string name() const { return path.filename().string(); }
};

/// Reads the pictures and searches the board in each, on all cores; tells the log how far it is.
/// Damaged files, boards of another size, blur and glare end up as reasons, never as an exception.
/// Blur is judged against the sharper half of the series, since lenses differ.
std::vector<SeenPicture> look_at_pictures(const std::vector<std::filesystem::path>& files,
                                          const CalibrationBoards& boards);

/// A picture that is at hand already; it is not judged by blur and glare yet.
SeenPicture look_at_picture(const GreyImage& grey, const std::filesystem::path& path,
                            const CalibrationBoards& boards);

/// How the board that the pictures show was printed, as BoardSighting says it.
struct PrintedBoard {
    bool inverted = false, legacy = false;
};
PrintedBoard printed_board_of(const std::vector<SeenPicture>& pictures);

/// What is usual in a series of pictures in which the board was found.
struct UsualPicture {
    double blur_px = 0, sharpness = 0, saturated = 0, burnt_out_share = 0;
};
UsualPicture usual_of(const std::vector<SeenPicture>& pictures);

/// Refuses a picture of the board that is blurred or has glare on the board by what is usual; to
/// the reason of a picture without a board, says whether blur or glare may be why.
void judge_blur_and_glare(SeenPicture& picture, const UsualPicture& usual);

/// The size that most pictures have; pictures of another size are refused with the reason.
void require_one_size(std::vector<SeenPicture>& pictures);

/// Refuses every picture whose corners are those of an earlier one to the last digit: a file that
/// was copied weighs double and makes any lens look right on withheld views.
void refuse_repeated(std::vector<SeenPicture>& pictures);

/// Throws Error if most pictures show a board of one other size, or mirrored markers: the one
/// sentence that spares a list of reasons.
void refuse_wrong_board(const std::vector<SeenPicture>& pictures, const CalibrationBoards& boards);

}  // namespace vantage
