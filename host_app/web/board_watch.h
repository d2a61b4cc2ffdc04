#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "common/board/calibration_boards.h"
#include "common/image/image.h"

namespace vantage {

/// Looks for the calibration board in pictures of rigs, on a thread of its own of low priority. It
/// looks at a picture only when asked, and at one at a time. Thread-safe.
class BoardWatch {
  public:
    explicit BoardWatch(CalibrationBoards boards);
    ~BoardWatch();
    BoardWatch(const BoardWatch&) = delete;
    BoardWatch& operator=(const BoardWatch&) = delete;

    /// The newest result for the rig as JSON; empty if there is none yet. Begins to look at the
    /// picture unless a search is under way.
    ///   found     whether a board was found, else `why` completes a sentence about the picture
    ///   seen, of  corners found, and corners of all boards
    ///   corners   [x, y] as shares of the picture's width and height
    ///   square_px, blur_px, burnt_out_share, mirrored
    std::string ask(const std::string& rig, const ColourImage& picture);

  private:
    struct Request {
        std::string rig;
        ColourImage picture;
    };
    void run();

    const CalibrationBoards boards_;
    std::mutex mutex_;  ///< guards all below
    std::condition_variable changed_;
    std::optional<Request> request_;
    bool is_searching_ = false, is_ending_ = false;
    std::string rig_, result_;  ///< of the newest search
    std::thread thread_;
};

/// What a picture shows of the boards, as BoardWatch::ask() has it.
std::string board_sighting_json(const GreyImage& picture, const CalibrationBoards& boards);

/// The boards of the option board=: "9x6" for the inner corners of a chessboard, or the file that
/// `vantage-calib board` wrote. Throws Error for a value that is neither.
CalibrationBoards boards_of_option(const std::string& value);

}  // namespace vantage
