#include "host_app/web/web_desk.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "common/base/error.h"
#include "common/base/this_thread.h"
#include "common/board/board_file.h"
#include "common/board/board_finder.h"
#include "common/wire/random_id.h"

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

namespace {

constexpr int most_picture_width = 960, jpeg_quality = 70;
constexpr std::chrono::milliseconds picture_period{160};
/// Attempts at the PIN: one in two seconds, and five at once after a rest.
constexpr double attempts_per_second = 0.5, attempts_at_once = 5;
constexpr const char* html_type = "text/html; charset=utf-8";

WebAnswer refusal(unsigned status, std::string sentence) {
    return {status, "text/plain; charset=utf-8", std::move(sentence) + "\n", {}};
}

/// Compares in a time that does not tell where they differ.
bool is_same_secret(std::string_view a, std::string_view b) {
    if (a.size() != b.size()) return false;
    unsigned difference = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
    return difference == 0;
}

/// A measure of focus: the spread of the Laplacian of luma in the middle of the picture.
double sharpness_of(const ColourImage& image) {
    const cv::Rect middle(image.cols / 4, image.rows / 4, image.cols / 2, image.rows / 2);
    if (middle.area() == 0) return 0;
    cv::Mat grey, edges;
    cv::cvtColor(image(middle), grey, cv::COLOR_RGBA2GRAY);
    cv::Laplacian(grey, edges, CV_16S);
    cv::Scalar mean, deviation;
    cv::meanStdDev(edges, mean, deviation);
    return deviation[0];
}

}  // namespace

bool is_loopback_host(std::string_view host) {
    if (host.starts_with('[')) return host.substr(0, host.find(']')) == "[::1";
    const std::string_view name = host.substr(0, host.find(':'));
    return name == "localhost" || name.starts_with("127.");
}

WebDesk::WebDesk(Settings settings, OperatorInputBox& input)
    : settings_(std::move(settings)),
      session_(fmt::format("{:016x}{:016x}", random_id(), random_id())),
      intake_(input),
      attempts_(attempts_per_second, attempts_at_once) {
    if (settings_.boards) boards_.emplace(*settings_.boards);
}

void WebDesk::show(WebShown shown) {
    // The old pictures are released after the lock.
    const std::lock_guard lock(shown_mutex_);
    std::swap(shown_, shown);
}

WebShown WebDesk::shown() const {
    const std::lock_guard lock(shown_mutex_);
    return shown_;
}

WebStats WebDesk::stats() const {
    const std::lock_guard lock(mutex_);
    return stats_;
}

WebAnswer WebDesk::answer(const WebRequest& request, MonotonicTime now) {
    const std::lock_guard lock(mutex_);
    WebAnswer answer = answer_to(request, now);
    ++stats_.requests;
    constexpr unsigned first_error = 400;
    if (answer.status >= first_error) ++stats_.refused;
    answer.headers.emplace_back("Cache-Control", "no-store");
    answer.headers.emplace_back("X-Content-Type-Options", "nosniff");
    answer.headers.emplace_back("X-Frame-Options", "DENY");
    answer.headers.emplace_back("Referrer-Policy", "no-referrer");
    return answer;
}

WebAnswer WebDesk::answer_to(const WebRequest& request, MonotonicTime now) {
    if (settings_.is_local && !is_loopback_host(request.host))
        return refusal(403, "this page is for this computer: open it at 127.0.0.1 or localhost");
    const bool is_read = request.method == "GET" || request.method == "HEAD";
    if (!is_read && request.method != "POST") return refusal(405, "only GET and POST");
    if (request.path == "/" && is_read) return page();
    if (!is_read && !request.is_from_page)
        return refusal(403, "a request that changes something needs the header X-Vantage");
    if (request.path == "/login" && !is_read) return log_in(request, now);
    if (!settings_.pin.empty() && !is_same_secret(request.cookie, session_))
        return refusal(401, "the PIN is needed");
    if (request.path == "/command" && !is_read) return obey(request, now);
    if (!is_read) return refusal(405, "only GET");
    if (request.path == "/state") return {200, "application/json", shown().state, {}};
    if (request.path == "/programme.jpg") return picture("", now);
    const auto given = request.query.find("rig");
    const std::string rig = given == request.query.end() ? "" : given->second;
    if (request.path == "/rig.jpg") return picture(rig, now);
    if (request.path == "/board") return board(rig);
    return refusal(404, "there is no such page");
}

WebAnswer WebDesk::page() const {
    WebAnswer answer{200, html_type, std::string(embedded_web_page().front().text), {}};
    answer.headers.emplace_back(
        "Content-Security-Policy",
        "default-src 'none'; img-src 'self' blob: data:; style-src 'unsafe-inline'; script-src "
        "'unsafe-inline'; connect-src 'self'; base-uri 'none'; form-action 'none'");
    return answer;
}

WebAnswer WebDesk::log_in(const WebRequest& request, MonotonicTime now) {
    if (settings_.pin.empty()) return refusal(404, "no PIN is asked for");
    if (!attempts_.take(now)) return refusal(429, "too many attempts; wait a few seconds");
    if (!is_same_secret(request.body, settings_.pin)) return refusal(401, "that is not the PIN");
    WebAnswer answer{204, "text/plain", "", {}};
    answer.headers.emplace_back(
        "Set-Cookie", fmt::format("vantage={}; Path=/; HttpOnly; SameSite=Strict{}", session_,
                                  settings_.is_secure ? "; Secure" : ""));
    return answer;
}

WebAnswer WebDesk::obey(const WebRequest& request, MonotonicTime now) {
    if (!settings_.has_control)
        return refusal(403, "this page only shows: the host needs ?control=yes behind --web");
    if (request.body.empty() || request.body.size() > most_web_body_bytes)
        return refusal(400, "a command has 1 to 200 bytes");
    try {
        if (!intake_.take(parse_typed_command(request.body), now))
            return refusal(429, "too many commands; wait a moment");
    } catch (const Error& error) {
        return refusal(400, error.what());
    }
    ++stats_.commands;
    return {204, "text/plain", "", {}};
}

ColourImage WebDesk::newest(const std::string& rig) const {
    const WebShown shown = this->shown();
    if (rig.empty()) return shown.picture;
    if (shown.set)
        for (const FrameSet::Slot& slot : shown.set->slots)
            if (slot.rig == rig && slot.frame) return slot.frame->colour;
    return {};
}

WebAnswer WebDesk::picture(const std::string& rig, MonotonicTime now) {
    Picture* kept = nullptr;
    if (const auto found = pictures_.find(rig); found != pictures_.end()) kept = &found->second;
    if (!kept || now - kept->made >= picture_period) {
        const ColourImage image = newest(rig);
        if (image.empty()) {
            pictures_.erase(rig);
            return refusal(404, rig.empty() ? "there is no picture yet"
                                            : "the rig has no picture in the present frame set");
        }
        ColourImage small = image;
        if (image.cols > most_picture_width)
            cv::resize(image, small,
                       cv::Size(most_picture_width, image.rows * most_picture_width / image.cols),
                       0, 0, cv::INTER_AREA);
        const std::vector<std::byte> jpeg = encoder_.encode(small, jpeg_quality, Chroma::half);
        kept = &pictures_[rig];
        *kept = {std::make_shared<const std::string>(reinterpret_cast<const char*>(jpeg.data()),
                                                     jpeg.size()),
                 rig.empty() ? 0 : sharpness_of(image), now};
    }
    WebAnswer answer{200, "image/jpeg", *kept->jpeg, {}};
    if (!rig.empty())
        answer.headers.emplace_back("X-Sharpness", fmt::format("{:.1f}", kept->sharpness));
    return answer;
}

WebAnswer WebDesk::board(const std::string& rig) {
    if (!boards_)
        return refusal(404, "no board is looked for: the host needs ?board= behind --web");
    const ColourImage image = rig.empty() ? ColourImage() : newest(rig);
    if (image.empty()) return refusal(404, "the rig has no picture in the present frame set");
    std::string sighting = boards_->ask(rig, image);
    return {200, "application/json", sighting.empty() ? "null" : std::move(sighting), {}};
}

}  // namespace vantage
