#pragma once

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "common/base/files/embedded_text.h"
#include "common/base/time/time.h"
#include "common/board/calibration_boards.h"
#include "common/image/image.h"
#include "common/receive/frame_set.h"
#include "common/wire/codec/colour_codec.h"
#include "host_app/control/ports/control_port.h"

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

/// The boards that a picture shows, as the JSON of BoardWatch::ask().
std::string board_sighting_json(const GreyImage& picture, const CalibrationBoards& boards);

/// The boards of the option board=: "9x6" for the inner corners of a chessboard, or the file that
/// `vantage-calib board` wrote. Throws Error for a value that is neither.
CalibrationBoards boards_of_option(const std::string& value);

/// The page for tablets and phones: one HTML file without any other.
std::span<const EmbeddedText> embedded_web_page();

/// A request to the web desk.
struct WebRequest {
    std::string method, path;
    std::map<std::string, std::string> query = {};
    std::string host = {};    ///< header Host
    std::string cookie = {};  ///< value of the cookie `vantage`
    bool is_from_page =
        false;  ///< has the header X-Vantage, which pages of other sites cannot send
    std::string body = {};
};
struct WebAnswer {
    unsigned status = 200;
    std::string type = "text/plain; charset=utf-8", body = {};
    std::vector<std::pair<std::string, std::string>> headers = {};
};

/// Largest body of a request: a command.
inline constexpr std::size_t most_web_body_bytes = 200;

/// The picture and the state that the page shows.
struct WebShown {
    ColourImage picture;                       ///< the programme; empty: none yet
    std::shared_ptr<const FrameSet> set = {};  ///< of the picture; null: none
    std::string state = "{}";                  ///< JSON
};

/// Counters for the summary.
struct WebStats {
    std::uint64_t requests = 0, refused = 0, commands = 0;
};

/// Answers the requests of the page for tablets and phones. It knows nothing of sockets. Pictures
/// are encoded when they are asked for, and at most six times a second, however many ask.
/// Thread-safe.
class WebDesk {
  public:
    struct Settings {
        bool has_control = false;                      ///< whether commands are obeyed
        std::string pin = {};                          ///< empty: none is asked for
        bool is_local = true;                          ///< listens at this computer only
        bool is_secure = false;                        ///< by TLS
        std::optional<CalibrationBoards> boards = {};  ///< that the page can look for
    };
    /// `input` must outlive it.
    WebDesk(Settings settings, OperatorInputBox& input);

    /// Never waits for an answer that is under way: the programme's thread may call it.
    void show(WebShown shown);
    WebAnswer answer(const WebRequest& request, MonotonicTime now);
    WebStats stats() const;

  private:
    struct Picture {
        std::shared_ptr<const std::string> jpeg;
        double sharpness = 0;
        MonotonicTime made{};
    };
    WebAnswer answer_to(const WebRequest& request, MonotonicTime now);
    WebAnswer page() const;
    WebAnswer log_in(const WebRequest& request, MonotonicTime now);
    WebAnswer obey(const WebRequest& request, MonotonicTime now);
    /// `rig`: empty for the programme.
    WebAnswer picture(const std::string& rig, MonotonicTime now);
    WebAnswer board(const std::string& rig);
    WebShown shown() const;
    ColourImage newest(const std::string& rig) const;

    Settings settings_;
    const std::string session_;       ///< value of the cookie of those who gave the PIN
    mutable std::mutex shown_mutex_;  ///< guards shown_ alone
    WebShown shown_;
    mutable std::mutex mutex_;  ///< guards all below
    WebStats stats_;
    CommandIntake intake_;
    MessageBudget attempts_;
    JpegEncoder encoder_;
    std::map<std::string, Picture> pictures_;
    std::optional<BoardWatch> boards_;
};

/// Whether the host of a request is this computer's loopback, so that a page of another site cannot
/// reach a local server by a name of its own.
bool is_loopback_host(std::string_view host);

}  // namespace vantage
