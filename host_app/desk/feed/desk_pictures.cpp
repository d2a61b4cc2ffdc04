#include "host_app/desk/feed/desk_pictures.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace vantage {
namespace {

/// Share of the depths at either end that the range leaves out: wild pixels of the matcher.
constexpr double end_share = 0.02;
/// Share of the distance to the new range that each picture moves it by.
constexpr double follow_share = 0.1;
/// Smallest ratio of farthest to nearest depth, for a scene that is one wall.
constexpr double min_ratio = 1.1;
constexpr int colours = 256;

std::vector<cv::Vec4b> cividis() {
    cv::Mat1b ramp(1, colours);
    for (int i = 0; i < colours; ++i) ramp(0, i) = static_cast<unsigned char>(i);
    cv::Mat3b bgr;
    cv::applyColorMap(ramp, bgr, cv::COLORMAP_CIVIDIS);
    std::vector<cv::Vec4b> table;
    for (const cv::Vec3b& c : bgr) table.emplace_back(c[2], c[1], c[0], 255);
    return table;
}

/// Largest width of a rig's picture: a quarter of the width of a 1080-row desk needs no more.
constexpr int max_rig_picture_width_px = 320;

void show(std::optional<Texture>& texture, const ColourImage& picture) {
    if (!texture || texture->size() != picture.size())
        texture.emplace(TextureFormat::rgba8, picture.cols, picture.rows, Filter::linear);
    texture->upload(picture);
}

/// Reduces a size by a whole factor, so that every pixel averages whole pixels of the source.
cv::Size reduced(cv::Size size) {
    const int reduction =
        std::max(1, (size.width + max_rig_picture_width_px - 1) / max_rig_picture_width_px);
    return {std::max(1, size.width / reduction), std::max(1, size.height / reduction)};
}

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

DepthImage depth_of(const DisparityImage& disparity, const DisparityScale& scale) {
    DepthImage depth(disparity.size());
    std::transform(disparity.begin(), disparity.end(), depth.begin(),
                   [&](std::uint16_t steps) { return scale.depth_m(steps); });
    return depth;
}

void DepthRange::follow(const DepthImage& depth) {
    std::vector<float> known;
    for (const float m : depth)
        if (m > 0) known.push_back(m);
    if (known.empty()) return;
    const auto at = [&](double share) {
        const auto place = known.begin() + static_cast<std::ptrdiff_t>(
                                               share * static_cast<double>(known.size() - 1));
        std::nth_element(known.begin(), place, known.end());
        return static_cast<double>(*place);
    };
    const double nearest = at(end_share), farthest = at(1 - end_share);
    const double share = nearest_m > 0 ? follow_share : 1;
    nearest_m += share * (nearest - nearest_m);
    farthest_m += share * (farthest - farthest_m);
}

ColourImage depth_colours(const DepthImage& depth, const DepthRange& range) {
    static const std::vector<cv::Vec4b> table = cividis();
    ColourImage picture(depth.size(), cv::Vec4b(0, 0, 0, 255));
    if (range.nearest_m <= 0) return picture;
    const double farthest_m = std::max(range.farthest_m, min_ratio * range.nearest_m);
    const double scale = (colours - 1) / std::log(farthest_m / range.nearest_m);
    std::transform(depth.begin(), depth.end(), picture.begin(), [&](float m) {
        if (m <= 0) return cv::Vec4b(0, 0, 0, 255);
        const double nearness = scale * std::log(farthest_m / m);
        return table[static_cast<std::size_t>(std::clamp(nearness, 0.0, colours - 1.0))];
    });
    return picture;
}

void RigPictures::take(const FrameSet& set) {
    for (const FrameSet::Slot& slot : set.slots) {
        if (!slot.frame) continue;
        const RigFrame& frame = *slot.frame;
        Pictures& pictures = pictures_[slot.rig];
        if (!frame.colour.empty()) {
            ColourImage small;
            cv::resize(frame.colour, small, reduced(frame.colour.size()), 0, 0, cv::INTER_AREA);
            show(pictures.colour, small);
        }
        if (!frame.disparity.empty()) {
            // Nearest neighbour: a mean of two surfaces' disparities is no surface.
            DisparityImage small;
            cv::resize(frame.disparity, small, reduced(frame.disparity.size()), 0, 0,
                       cv::INTER_NEAREST);
            const DepthImage depth =
                depth_of(small, DisparityScale(frame.geometry, frame.disparity.cols));
            pictures.range.follow(depth);
            show(pictures.depth, depth_colours(depth, pictures.range));
        }
    }
}

void RigPictures::take_mask(const std::string& rig, const cv::Mat1b& matte) {
    if (matte.empty()) return;
    ColourImage picture;
    cv::cvtColor(matte, picture, cv::COLOR_GRAY2RGBA);
    show(pictures_[rig].mask, picture);
}

const RigPictures::Pictures* RigPictures::of(const std::string& rig) const {
    const auto found = pictures_.find(rig);
    return found == pictures_.end() ? nullptr : &found->second;
}

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
