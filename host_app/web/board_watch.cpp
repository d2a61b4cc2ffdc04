#include "host_app/web/board_watch.h"

#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "common/base/error.h"
#include "common/base/this_thread.h"
#include "common/board/board_file.h"
#include "common/board/board_finder.h"

namespace vantage {
namespace {

double rounded(double value, double steps) { return std::round(value * steps) / steps; }

}  // namespace

CalibrationBoards boards_of_option(const std::string& value) {
    // The size of the squares does not matter for finding them.
    constexpr double any_square_m = 0.03;
    CalibrationBoards boards;
    if (value.ends_with(".toml"))
        boards.add("the board", load_body(value));
    else
        boards = chessboard_pattern(value, any_square_m);
    boards.validate();
    return boards;
}

std::string board_sighting_json(const GreyImage& picture, const CalibrationBoards& boards) {
    const BoardSighting sighting = find_board(picture, boards);
    int all = 0;
    for (const BoardPattern& board : boards.boards) all += board.corner_count();
    constexpr double thousandths = 1000, tenths = 10;
    nlohmann::ordered_json corners = nlohmann::ordered_json::array();
    for (const BoardCorner& corner : sighting.corners)
        corners.push_back({rounded((corner.pixel.x() + 0.5) / picture.cols, 10 * thousandths),
                           rounded((corner.pixel.y() + 0.5) / picture.rows, 10 * thousandths)});
    return nlohmann::ordered_json{
        {"found", sighting.found()},
        {"why", sighting.reason},
        {"seen", sighting.corners.size()},
        {"of", all},
        {"square_px", rounded(sighting.square_px, tenths)},
        {"blur_px", rounded(sighting.blur_px, 10 * tenths)},
        {"burnt_out_share", rounded(sighting.burnt_out_share, thousandths)},
        {"mirrored", sighting.mirrored},
        {"corners", corners}}
        .dump();
}

BoardWatch::BoardWatch(CalibrationBoards boards)
    : boards_(std::move(boards)), thread_([this] { run(); }) {}

BoardWatch::~BoardWatch() {
    {
        const std::lock_guard lock(mutex_);
        is_ending_ = true;
    }
    changed_.notify_one();
    thread_.join();
}

std::string BoardWatch::ask(const std::string& rig, const ColourImage& picture) {
    const std::lock_guard lock(mutex_);
    if (!is_searching_ && !request_) {
        request_ = Request{rig, picture};
        changed_.notify_one();
    }
    return rig_ == rig ? result_ : "";
}

void BoardWatch::run() {
    name_this_thread("board watch");
    // On idle processors only, a search would never end beside a software renderer.
    constexpr int niceness = 10;
    make_this_thread_nice(niceness);
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return request_ || is_ending_; });
        if (is_ending_) return;
        Request request = std::move(*request_);
        request_.reset();
        is_searching_ = true;
        lock.unlock();
        GreyImage grey;
        cv::cvtColor(request.picture, grey, cv::COLOR_RGBA2GRAY);
        request.picture.release();
        std::string result;
        try {
            result = board_sighting_json(grey, boards_);
        } catch (const std::exception& error) {
            result = nlohmann::json{{"found", false}, {"why", error.what()}}.dump();
        }
        lock.lock();
        is_searching_ = false;
        rig_ = std::move(request.rig);
        result_ = std::move(result);
    }
}

}  // namespace vantage
