#include "calib_tools/live/board_film.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "common/base/counted.h"
#include "common/base/error.h"
#include "common/base/files/folder.h"
#include "common/base/log.h"
#include "common/base/time/time.h"
#include "common/board/chessboard_finder.h"
#include "common/image/image_file.h"

namespace vantage {
namespace {

/// Smallest movement of the board that counts as a new position, as a share of the image width.
constexpr double new_place_share = 0.04;
/// Shortest time before the same reason is logged again.
constexpr std::chrono::seconds repeat_after{3};
constexpr int looks_between_size_tests = 5;

std::filesystem::path file_of(const FilmedCamera& camera, std::uint64_t pulse) {
    return camera.folder / fmt::format("{}_{}.png", camera.is_left ? "left" : "right", pulse);
}

/// Pulses of the images in a camera's folder.
std::set<std::uint64_t> pulses_in_folder(const FilmedCamera& camera) {
    const std::string side = camera.is_left ? "left_" : "right_";
    std::set<std::uint64_t> pulses;
    for (const auto& entry : std::filesystem::directory_iterator(camera.folder)) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with(camera.is_left ? "left" : "right")) continue;
        std::uint64_t pulse = 0;
        const char* const end = name.data() + name.size();
        const auto [rest, error] =
            std::from_chars(name.data() + std::min(side.size(), name.size()), end, pulse);
        if (!name.starts_with(side) || error != std::errc() ||
            std::string_view(rest, static_cast<std::size_t>(end - rest)) != ".png")
            fail("{} is not a picture of a live film ({}PULSE.png): give a folder without pictures",
                 entry.path().string(), side);
        pulses.insert(pulse);
    }
    return pulses;
}

void require_empty(const FilmedCamera& camera) {
    const std::string side = camera.is_left ? "left" : "right";
    for (const auto& entry : std::filesystem::directory_iterator(camera.folder))
        if (entry.path().filename().string().starts_with(side))
            fail(
                "{} holds {} pictures already: go on filming from them (--go-on), give a folder "
                "without pictures, or calibrate from those without --live",
                camera.folder.string(), side);
}

/// Loads the frame sets that an earlier film left in the folders.
void take_up(const std::vector<FilmedCamera>& cameras, const CalibrationBoards& boards,
             BoardFilm& film) {
    std::set<std::uint64_t> pulses;
    for (const FilmedCamera& camera : cameras) pulses.merge(pulses_in_folder(camera));
    film.pulses.assign(pulses.begin(), pulses.end());
    for (std::size_t c = 0; c < cameras.size(); ++c) {
        std::vector<std::filesystem::path> files;
        for (const std::uint64_t pulse : pulses) files.push_back(file_of(cameras[c], pulse));
        film.pictures[c] = look_at_pictures(files, boards);
    }
}

std::string kept_sentence(const BoardFilm& film, const std::vector<FilmedCamera>& cameras) {
    std::string folders;
    std::set<std::filesystem::path> named;
    for (const FilmedCamera& camera : cameras)
        if (named.insert(camera.folder).second)
            folders += (folders.empty() ? "" : ", ") + camera.folder.string();
    return fmt::format(
        "{} kept in {}: the same command with --go-on films more, and without --live and what goes "
        "with it (--views, --patience-s) it calibrates from {}",
        counted(film.pulses.size(), "instant"), folders, film.pulses.size() == 1 ? "it" : "them");
}

/// Mean movement of the corners that both images show; empty if they share too few.
std::optional<double> way_px(const BoardCorners& a, const BoardCorners& b) {
    constexpr int fewest = 4;
    double sum = 0;
    int count = 0;
    for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();) {
        if (i->id < j->id) {
            ++i;
        } else if (j->id < i->id) {
            ++j;
        } else {
            sum += (i->pixel - j->pixel).norm();
            ++count;
            ++i;
            ++j;
        }
    }
    if (count < fewest) return std::nullopt;
    return sum / count;
}

/// True if the board is where it was in an earlier kept frame set, for every camera that sees it.
bool shows_nothing_new(const BoardFilm& film, const std::vector<SeenPicture>& pictures) {
    for (std::size_t k = 0; k < film.pulses.size(); ++k) {
        bool same = true;
        for (std::size_t c = 0; same && c < pictures.size(); ++c) {
            const SeenPicture& now = pictures[c];
            if (!now.sighting.found()) continue;
            const auto way = way_px(now.sighting.corners, film.pictures[c][k].sighting.corners);
            same = way && *way < new_place_share * now.width_px;
        }
        if (same) return true;
    }
    return false;
}

/// Logs a reason when it is new, or again after repeat_after.
class Notice {
  public:
    void say(const std::string& sentence) {
        const MonotonicTime now = MonotonicClock::now();
        if (sentence == last_ && now - when_ < repeat_after) return;
        log_info("{}", sentence);
        last_ = sentence;
        when_ = now;
    }

  private:
    std::string last_;
    MonotonicTime when_{};
};

std::string joined(const std::vector<std::string>& sentences) {
    std::string all;
    for (const std::string& sentence : sentences) all += (all.empty() ? "" : "; ") + sentence;
    return all;
}

/// Throws Error once two images show a chessboard of the same other size, since waiting does not
/// help then.
class OtherBoardWatch {
  public:
    explicit OtherBoardWatch(const CalibrationBoards& boards)
        : pattern_(boards.boards.front()),
          watches_(boards.is_one_board() && pattern_.kind == BoardKind::chessboard) {}

    void look(const GreyImage& picture) {
        if (!watches_ || looks_++ % looks_between_size_tests != 0) return;
        const std::optional<BoardPattern> other = find_other_size(picture, pattern_);
        if (other && ++votes_[{other->columns, other->rows}] >= 2)
            fail(
                "the rigs see a board of {} inner corners, not {} (corners where four squares meet "
                "are counted, not squares)",
                other->size_name(), pattern_.size_name());
    }

  private:
    BoardPattern pattern_;
    bool watches_;
    int looks_ = 0;
    std::map<std::pair<int, int>, int> votes_;
};

/// Films into `film` until nothing is missing, `most` frame sets are kept, or the program is asked
/// to stop. Returns a sentence with the reason for the end.
std::string film_on(LiveRigs& rigs, const std::vector<FilmedCamera>& cameras,
                    const CalibrationBoards& boards, std::size_t most, const FilmRule& rule,
                    const FilmAdvice& advice, BoardFilm& film) {
    OtherBoardWatch other_board(boards);
    Notice notice;
    log_info("show the board; Ctrl-C ends the film and calibrates from what is kept");
    while (film.pulses.size() < most) {
        const std::optional<LiveInstant> instant = rigs.next();
        if (!instant) return "the film was ended";
        std::vector<SeenPicture> pictures(cameras.size());
        std::vector<const ColourImage*> raw(cameras.size(), nullptr);
        for (std::size_t c = 0; c < cameras.size(); ++c) {
            const std::optional<RawPair>& pair = instant->pairs[cameras[c].rig];
            if (pair) raw[c] = cameras[c].is_left ? &pair->left : &pair->right;
            pictures[c].path = file_of(cameras[c], instant->pulse);
            pictures[c].sighting.reason = "did not come in time";
        }
        cv::parallel_for_(cv::Range(0, static_cast<int>(cameras.size())), [&](const cv::Range& r) {
            for (int i = r.start; i < r.end; ++i) {
                const auto c = static_cast<std::size_t>(i);
                if (raw[c])
                    pictures[c] = look_at_picture(to_grey(*raw[c]), pictures[c].path, boards);
            }
        });
        bool anyone = false;
        for (std::size_t c = 0; c < cameras.size(); ++c) {
            anyone = anyone || pictures[c].sighting.found();
            judge_blur_and_glare(pictures[c], usual_of(film.pictures[c]));
        }
        if (!anyone && raw[0]) other_board.look(to_grey(*raw[0]));
        const std::string fault = rule(pictures);
        if (!fault.empty()) {
            notice.say(fault);
            continue;
        }
        if (shows_nothing_new(film, pictures)) {
            notice.say("this place is kept already: move the board on");
            continue;
        }
        for (std::size_t c = 0; c < cameras.size(); ++c) {
            if (raw[c]) write_colour_image(pictures[c].path, *raw[c]);
            film.pictures[c].push_back(std::move(pictures[c]));
        }
        film.pulses.push_back(instant->pulse);
        const std::vector<std::string> missing = advice(film);
        log_info("{} kept of {} (pulse {}); {}", film.pulses.size(), most, instant->pulse,
                 missing.empty() ? "nothing is missing" : "still missing: " + joined(missing));
        if (missing.empty()) return "the film is complete";
    }
    return fmt::format("the film has what was asked for (--views): {}", counted(most, "instant"));
}

}  // namespace

BoardFilm film_board(LiveRigs& rigs, const std::vector<FilmedCamera>& cameras,
                     const CalibrationBoards& boards, const FilmOptions& options,
                     const FilmRule& rule, const FilmAdvice& advice) {
    BoardFilm film;
    film.pictures.resize(cameras.size());
    for (const FilmedCamera& camera : cameras) {
        make_folder(camera.folder);
        if (!options.go_on) require_empty(camera);
    }
    if (options.go_on) {
        take_up(cameras, boards, film);
        if (!film.pulses.empty())
            log_info("{} kept from before; still missing: {}", film.pulses.size(),
                     joined(advice(film)));
    }
    try {
        const std::string end = film_on(rigs, cameras, boards, options.most, rule, advice, film);
        if (film.pulses.empty()) fail("the film ended before a picture of the board could be kept");
        film.kept = kept_sentence(film, cameras);
        log_info("{}; {}", end, film.kept);
    } catch (const Error& error) {
        if (film.pulses.empty()) throw;
        fail("{}; {}", error.what(), kept_sentence(film, cameras));
    }
    return film;
}

}  // namespace vantage
