#include "calib_tools/pictures/film_frames.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "common/av/video_reader.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/image/image_file.h"

namespace vantage {
namespace {

std::filesystem::path new_temporary_folder() {
    std::string name = (std::filesystem::temp_directory_path() / "vantage-film-XXXXXX").string();
    if (!::mkdtemp(name.data())) fail("cannot make a temporary folder such as {}", name);
    return name;
}

}  // namespace

std::filesystem::path film_among(const std::vector<std::string>& names) {
    std::error_code ignored;
    if (names.size() != 1 || !std::filesystem::is_regular_file(names.front(), ignored) ||
        is_picture_file(names.front()))
        return {};
    return names.front();
}

FilmFrames::FilmFrames(const std::vector<std::filesystem::path>& films, std::size_t most) {
    std::uint64_t frames = std::numeric_limits<std::uint64_t>::max();
    for (const std::filesystem::path& film : films)
        frames = std::min(frames, VideoReader(film.string()).count());
    const std::uint64_t step = std::max<std::uint64_t>(1, (frames + most - 1) / most);
    folder_ = new_temporary_folder();
    for (std::size_t i = 0; i < films.size(); ++i) {
        VideoReader reader(films[i].string());
        const std::filesystem::path folder = folder_ / std::to_string(i);
        std::filesystem::create_directory(folder);
        std::vector<std::filesystem::path> pictures;
        for (std::uint64_t number = 0; number < frames; number += step) {
            if (number > 0 && !reader.skip(step - 1)) break;
            const std::optional<ColourImage> frame = reader.next();
            if (!frame) break;
            const std::string name =
                fmt::format("{} frame {:06}.png", films[i].filename().string(), number);
            write_colour_image(folder / name, *frame);
            pictures.push_back(folder / name);
        }
        log_info("{}: {} of its {} frames are searched for the board", films[i].string(),
                 pictures.size(), frames);
        pictures_.push_back(std::move(pictures));
    }
}

FilmFrames::~FilmFrames() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
}

}  // namespace vantage
