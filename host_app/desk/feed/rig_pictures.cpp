#include "host_app/desk/feed/rig_pictures.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace vantage {
namespace {

/// Enough for a quarter of the width of a 1080-row desk.
constexpr int most_width_px = 320;

void show(std::optional<Texture>& texture, const ColourImage& picture) {
    if (!texture || texture->size() != picture.size())
        texture.emplace(TextureFormat::rgba8, picture.cols, picture.rows, Filter::linear);
    texture->upload(picture);
}

/// `reduction`: whole pixels of the source to one.
cv::Size reduced(cv::Size size) {
    const int reduction = std::max(1, (size.width + most_width_px - 1) / most_width_px);
    return {std::max(1, size.width / reduction), std::max(1, size.height / reduction)};
}

}  // namespace

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
            // Not mixed: half of two surfaces is none.
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

}  // namespace vantage
