#include "host_app/desk/feed/clip_pictures.h"

#include "host_app/desk/feed/small_picture.h"

namespace vantage {
namespace {

constexpr std::chrono::milliseconds period{500};
constexpr std::size_t most_passed = 240;

}  // namespace

void ClipPictures::follow(const ClipBook& book, const MadePicture& picture, MonotonicTime now) {
    const std::uint64_t pulse = picture.job.instant->set->trigger_index;
    if (now - taken_ >= period) {
        taken_ = now;
        passed_.push_back({pulse, small_picture(picture.picture)});
        if (passed_.size() > most_passed) passed_.pop_front();
    }
    std::erase_if(places_, [&](const auto& place) { return !book.clips.contains(place.first); });
    for (const auto& [number, clip] : book.clips) {
        Place& place = places_[number];
        if (place.in != clip.in || place.out != clip.out) place = {clip.in, clip.out, {}};
        if (place.picture) continue;
        const Passed* nearest = nullptr;
        for (const Passed& passed : passed_)
            if (passed.pulse >= clip.in && passed.pulse < clip.out &&
                (!nearest || passed.pulse < nearest->pulse))
                nearest = &passed;
        ColourImage shown;
        if (nearest)
            shown = nearest->picture;
        else if (pulse >= clip.in && pulse < clip.out)
            shown = small_picture(picture.picture);
        if (shown.empty()) continue;
        place.picture.emplace(TextureFormat::rgba8, shown.cols, shown.rows, Filter::linear);
        place.picture->upload(shown);
    }
}

const Texture* ClipPictures::of(int number) const {
    const auto place = places_.find(number);
    return place != places_.end() && place->second.picture ? &*place->second.picture : nullptr;
}

}  // namespace vantage
