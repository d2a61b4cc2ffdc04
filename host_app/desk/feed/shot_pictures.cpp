#include "host_app/desk/feed/shot_pictures.h"

#include <algorithm>

#include "host_app/desk/feed/small_picture.h"

namespace vantage {
namespace {

/// While the camera stays there, for the performers do not.
constexpr std::chrono::seconds taken_again_after{2};

}  // namespace

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
            (place.picture && now - place.taken < taken_again_after))
            continue;
        const ColourImage small = small_picture(picture.picture);
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
