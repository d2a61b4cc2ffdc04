#include "calib_tools/pictures/seen_picture.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <map>
#include <optional>

#include <opencv2/imgproc.hpp>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/board/chessboard_finder.h"
#include "common/image/image_file.h"

namespace vantage {
namespace {

double quantile(std::vector<double> values, double share) {
    if (values.empty()) return 0;
    const auto place = values.begin() +
                       static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return *place;
}

/// Slope of the steepest edges, relative to the contrast of the image. Noise has much fine detail
/// but hardly changes edges of tens of grey levels.
double sharpness_of(const GreyImage& grey) {
    constexpr double steepest = 0.999, darkest = 0.001;
    cv::Mat1f right, down;
    cv::Sobel(grey, right, CV_32F, 1, 0, 1, 0.5);
    cv::Sobel(grey, down, CV_32F, 0, 1, 1, 0.5);
    cv::Mat1f slope;
    cv::magnitude(right, down, slope);
    const std::vector<double> slopes(slope.begin(), slope.end()), levels(grey.begin(), grey.end());
    const double contrast = quantile(levels, steepest) - quantile(levels, darkest);
    return quantile(slopes, steepest) / std::max(1.0, contrast);
}

void judge(const GreyImage& grey, SeenPicture& picture) {
    picture.sharpness = sharpness_of(grey);
    picture.saturated =
        static_cast<double>(cv::countNonZero(grey >= 254)) / static_cast<double>(grey.total());
}

GreyImage grey_of(const SeenPicture& picture, CodeRange range) {
    return picture.pixels.empty() ? to_grey(read_colour_image(picture.path, range))
                                  : picture.pixels;
}

void look_at(SeenPicture& picture, const CalibrationBoards& boards, CodeRange range) {
    try {
        SeenPicture seen = look_at_picture(grey_of(picture, range), picture.path, boards);
        seen.pixels = picture.pixels;
        picture = std::move(seen);
    } catch (const Error& error) {
        picture.sighting = {};
        picture.sighting.reason = error.what();
        // The sentence already begins with the name.
        const std::string path = picture.path.string() + " ";
        if (picture.sighting.reason.starts_with(path))
            picture.sighting.reason.erase(0, path.size());
    }
}

void refuse(SeenPicture& picture, std::string reason) {
    picture.sighting.corners.clear();
    picture.sighting.reason = std::move(reason);
}

/// Gives images whose markers do not tell the board's layout the layout that other images show.
void settle_layout(std::vector<SeenPicture>& pictures, const CalibrationBoards& boards,
                   const CodeRange& range) {
    if (!boards.is_one_board()) return;
    const bool described = boards.boards.front().starts_white();
    int others = 0, as_described = 0;
    for (const SeenPicture& p : pictures)
        if (p.sighting.found() && p.sighting.layout_is_sure)
            ++(p.sighting.legacy == described ? as_described : others);
    if (others <= as_described) return;
    CalibrationBoards settled = boards;
    settled.boards.front().legacy = !described;
    for (SeenPicture& p : pictures)
        if (p.sighting.found() && !p.sighting.layout_is_sure) look_at(p, settled, range);
}

}  // namespace

SeenPicture look_at_picture(const GreyImage& grey, const std::filesystem::path& path,
                            const CalibrationBoards& boards) {
    SeenPicture picture;
    picture.path = path;
    picture.width_px = grey.cols;
    picture.height_px = grey.rows;
    judge(grey, picture);
    picture.sighting = find_board(grey, boards);
    return picture;
}

PrintedBoard printed_board_of(const std::vector<SeenPicture>& pictures) {
    PrintedBoard printed;
    for (const SeenPicture& p : pictures) {
        printed.inverted = printed.inverted || (p.sighting.found() && p.sighting.inverted);
        printed.legacy = printed.legacy || (p.sighting.found() && p.sighting.legacy);
    }
    return printed;
}

UsualPicture usual_of(const std::vector<SeenPicture>& pictures) {
    std::vector<double> blurs, sharpnesses, saturations, burnt_out_shares;
    for (const SeenPicture& p : pictures) {
        if (!p.sighting.found()) continue;
        blurs.push_back(p.sighting.blur_px);
        sharpnesses.push_back(p.sharpness);
        saturations.push_back(p.saturated);
        burnt_out_shares.push_back(p.sighting.burnt_out_share);
    }
    return {quantile(blurs, 0.5), quantile(sharpnesses, 0.5), quantile(saturations, 0.5),
            quantile(burnt_out_shares, 0.5)};
}

void judge_blur_and_glare(SeenPicture& picture, const UsualPicture& usual) {
    const BoardSighting& s = picture.sighting;
    if (s.found()) {
        const double limit = std::max(1.5, 2.2 * usual.blur_px);
        if (s.blur_px > limit)
            refuse(picture, fmt::format("is blurred: edges of {:.1f} px where {:.1f} px is usual "
                                        "in this series and {:.1f} px the limit; hold the board "
                                        "still, in focus",
                                        s.blur_px, usual.blur_px, limit));
        else if (s.burnt_out_share > 0.08 + 1.5 * usual.burnt_out_share)
            refuse(picture, fmt::format("has glare on the board: {:.0f} % of it is overexposed "
                                        "where {:.0f} % is usual in this series; turn it away "
                                        "from the lamp or expose shorter",
                                        100 * s.burnt_out_share, 100 * usual.burnt_out_share));
    } else if (picture.width_px > 0 && !s.mirrored) {
        if (usual.sharpness > 0 && picture.sharpness < 0.5 * usual.sharpness)
            picture.sighting.reason += ": the picture is blurred";
        else if (picture.saturated > 0.02 + 2 * usual.saturated)
            picture.sighting.reason += fmt::format(
                ": {:.0f} % of the picture is overexposed (glare)", 100 * picture.saturated);
    }
}

std::vector<SeenPicture> look_at_pictures(const std::vector<std::filesystem::path>& files,
                                          const CalibrationBoards& boards) {
    std::vector<SeenPicture> pictures(files.size());
    for (std::size_t i = 0; i < files.size(); ++i) pictures[i].path = files[i];
    return look_at_pictures(std::move(pictures), boards);
}

std::vector<SeenPicture> look_at_pictures(std::vector<SeenPicture> pictures,
                                          const CalibrationBoards& boards) {
    std::vector<std::filesystem::path> files;
    for (const SeenPicture& picture : pictures)
        if (picture.pixels.empty()) files.push_back(picture.path);
    const CodeRange codes = common_code_range(files, files.size());
    const std::size_t total = pictures.size();
    std::atomic<std::size_t> done{0};
    const std::size_t step = std::max<std::size_t>(10, total / 10);
    std::vector<std::exception_ptr> failures(total);
    cv::parallel_for_(
        cv::Range(0, static_cast<int>(total)),
        [&](const cv::Range& range) {
            for (int i = range.start; i < range.end; ++i) {
                const auto index = static_cast<std::size_t>(i);
                try {
                    look_at(pictures[index], boards, codes);
                } catch (...) {
                    // An exception of the library must not end the thread pool.
                    failures[index] = std::current_exception();
                }
                const std::size_t count = ++done;
                if (count % step == 0 || count == total)
                    log_info("{} of {} pictures searched for the board", count, total);
            }
        },
        static_cast<double>(total));
    for (const std::exception_ptr& failure : failures)
        if (failure) std::rethrow_exception(failure);
    settle_layout(pictures, boards, codes);
    const PrintedBoard printed = printed_board_of(pictures);
    if (printed.inverted) log_info("the board is printed inverted, white for black");
    if (printed.legacy) log_info("the board has the layout of OpenCV before 4.6 (legacy)");
    const UsualPicture usual = usual_of(pictures);
    for (SeenPicture& picture : pictures) judge_blur_and_glare(picture, usual);
    return pictures;
}

void require_one_size(std::vector<SeenPicture>& pictures) {
    std::map<std::pair<int, int>, int> votes;
    for (const SeenPicture& p : pictures)
        if (p.width_px > 0) ++votes[{p.width_px, p.height_px}];
    if (votes.size() < 2) return;
    const auto most =
        std::max_element(votes.begin(), votes.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    const auto [width, height] = most->first;
    for (SeenPicture& p : pictures)
        if (p.width_px > 0 && (p.width_px != width || p.height_px != height))
            refuse(p, fmt::format("is {}x{} where the other pictures are {}x{}", p.width_px,
                                  p.height_px, width, height));
}

void refuse_repeated(std::vector<SeenPicture>& pictures) {
    const auto same = [](const BoardCorners& a, const BoardCorners& b) {
        return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                          [](const BoardCorner& x, const BoardCorner& y) {
                              return x.id == y.id && x.pixel == y.pixel;
                          });
    };
    for (std::size_t i = 0; i < pictures.size(); ++i)
        for (std::size_t k = 0; k < i && pictures[i].sighting.found(); ++k)
            if (pictures[k].sighting.found() &&
                same(pictures[i].sighting.corners, pictures[k].sighting.corners))
                refuse(pictures[i], fmt::format("is the same picture as {}", pictures[k].name()));
}

void refuse_wrong_board(const std::vector<SeenPicture>& pictures, const CalibrationBoards& boards) {
    std::size_t mirrored = 0, found = 0;
    std::vector<const SeenPicture*> without;
    for (const SeenPicture& p : pictures) {
        if (p.sighting.found())
            ++found;
        else if (p.width_px > 0)
            without.push_back(&p);
        if (p.sighting.mirrored) ++mirrored;
    }
    if (mirrored > found)
        fail(
            "the pictures are mirrored: the board's markers can be read in a mirror only ({} of {} "
            "pictures); turn mirroring off at the camera",
            mirrored, pictures.size());
    if (2 * found > pictures.size() || !boards.is_one_board()) return;
    const BoardPattern& pattern = boards.boards.front();
    if (pattern.kind != BoardKind::chessboard) return;
    constexpr std::size_t samples = 6;
    std::map<std::pair<int, int>, int> votes;
    for (std::size_t i = 0; i < std::min(samples, without.size()); ++i) {
        const SeenPicture& picture = *without[i * without.size() / samples % without.size()];
        const std::optional<BoardPattern> other = find_other_size(grey_of(picture, {}), pattern);
        if (other && ++votes[{other->columns, other->rows}] >= 2)
            fail(
                "the pictures show a board of {} inner corners, not {} (corners where four squares "
                "meet are counted, not squares)",
                other->size_name(), pattern.size_name());
    }
}

}  // namespace vantage
