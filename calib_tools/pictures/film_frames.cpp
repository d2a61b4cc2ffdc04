#include "calib_tools/pictures/film_frames.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "common/av/video_reader.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/image/image_file.h"

namespace vantage {
namespace {

SeenPicture unsearched(std::filesystem::path path, GreyImage pixels) {
    SeenPicture picture;
    picture.path = std::move(path);
    picture.pixels = std::move(pixels);
    return picture;
}

}  // namespace

std::filesystem::path film_among(const std::vector<std::string>& names) {
    std::error_code ignored;
    if (names.size() != 1 || !std::filesystem::is_regular_file(names.front(), ignored) ||
        is_picture_file(names.front()))
        return {};
    return names.front();
}

std::vector<std::vector<SeenPicture>> read_film_frames(
    const std::vector<std::filesystem::path>& films, std::size_t most) {
    std::uint64_t frames = std::numeric_limits<std::uint64_t>::max();
    for (const std::filesystem::path& film : films)
        frames = std::min(frames, VideoReader(film.string()).count());
    const std::uint64_t step = std::max<std::uint64_t>(1, (frames + most - 1) / most);
    std::vector<std::vector<SeenPicture>> series;
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    for (const std::filesystem::path& film : films) {
        VideoReader reader(film.string());
        std::vector<SeenPicture> pictures;
        for (std::uint64_t number = 0; number < frames; number += step) {
            if (number > 0 && !reader.skip(step - 1)) break;
            const std::optional<ColourImage> frame = reader.next();
            if (!frame) break;
            pictures.push_back(unsearched(
                fmt::format("{} frame {:06}", film.filename().string(), number), to_grey(*frame)));
        }
        log_info("{}: {} of its {} frames are searched for the board", film.string(),
                 pictures.size(), frames);
        fewest = std::min(fewest, pictures.size());
        series.push_back(std::move(pictures));
    }
    for (std::vector<SeenPicture>& pictures : series) pictures.resize(fewest);
    return series;
}

std::vector<SeenPicture> read_pictures(const std::vector<std::filesystem::path>& files) {
    CodeRange codes = common_code_range(files, files.size());
    std::vector<SeenPicture> pictures;
    pictures.reserve(files.size());
    for (const std::filesystem::path& file : files) try {
            pictures.push_back(unsearched(file, to_grey(read_colour_image(file, codes))));
        } catch (const Error&) {
            // The search reads the file again and gives the reason.
            pictures.push_back(unsearched(file, {}));
        }
    return pictures;
}

PictureHalves halves_of(const std::vector<SeenPicture>& both) {
    PictureHalves halves;
    for (const SeenPicture& picture : both) {
        const int width = picture.pixels.cols;
        if (picture.pixels.empty()) {
            halves.left.push_back(picture);
            halves.right.push_back(picture);
            continue;
        }
        if (width < 2 || width % 2 != 0)
            fail("{} is {} px wide, and two pictures side by side need an even width",
                 picture.name(), width);
        const auto half = [&](const char* side, int from) {
            return unsearched(fmt::format("{} {}", picture.name(), side),
                              picture.pixels.colRange(from, from + width / 2).clone());
        };
        halves.left.push_back(half("left", 0));
        halves.right.push_back(half("right", width / 2));
    }
    return halves;
}

}  // namespace vantage
