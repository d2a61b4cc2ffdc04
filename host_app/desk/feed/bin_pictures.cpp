#include "host_app/desk/feed/bin_pictures.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace vantage {
namespace {

/// Period at which pictures are kept for clips, and how many: two minutes.
constexpr std::chrono::milliseconds thumbnail_period{500};
constexpr std::size_t max_thumbnails = 240;
/// Period at which a shot's thumbnail is renewed while the camera stays at the shot.
constexpr std::chrono::seconds shot_renewal_period{2};
/// Width of a bin cell on a 1080-row desk; larger thumbnails would only cost memory.
constexpr int max_thumbnail_width_px = 192;

/// Scales a picture down to the size of a bin cell.
ColourImage thumbnail_of(const ColourImage& picture) {
    const double scale = std::min(1.0, static_cast<double>(max_thumbnail_width_px) / picture.cols);
    ColourImage small;
    cv::resize(picture, small, {}, scale, scale, cv::INTER_AREA);
    return small;
}

}  // namespace

void ClipPictures::follow(const ClipBook& book, const MadePicture& picture, MonotonicTime now) {
    const std::uint64_t pulse = picture.job.instant->set->trigger_index;
    if (now - taken_ >= thumbnail_period) {
        taken_ = now;
        passed_.push_back({pulse, thumbnail_of(picture.picture)});
        if (passed_.size() > max_thumbnails) passed_.pop_front();
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
            shown = thumbnail_of(picture.picture);
        if (shown.empty()) continue;
        place.picture.emplace(TextureFormat::rgba8, shown.cols, shown.rows, Filter::linear);
        place.picture->upload(shown);
    }
}

const Texture* ClipPictures::of(int number) const {
    const auto place = places_.find(number);
    return place != places_.end() && place->second.picture ? &*place->second.picture : nullptr;
}

void ShotPictures::follow(const FlightControls::Shots& shots, const MadePicture& picture,
                          MonotonicTime now) {
    for (std::size_t i = 0; i < places_.size(); ++i) {
        if (!shots[i]) {
            places_[i].reset();
            continue;
        }
        const CameraState camera = shots[i]->view.camera();
        if (!places_[i] || !is_same_view(places_[i]->view.camera(), camera))
            places_[i].emplace(Place{shots[i]->view, {}, {}});
        Place& place = *places_[i];
        if (!is_same_view(picture.job.camera, camera) ||
            (place.picture && now - place.taken < shot_renewal_period))
            continue;
        const ColourImage small = thumbnail_of(picture.picture);
        place.picture.emplace(TextureFormat::rgba8, small.cols, small.rows, Filter::linear);
        place.picture->upload(small);
        place.taken = now;
    }
}

const Texture* ShotPictures::of(std::size_t number) const {
    const std::optional<Place>& place = places_.at(number - 1);
    return place && place->picture ? &*place->picture : nullptr;
}

}  // namespace vantage
