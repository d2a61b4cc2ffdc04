#include "rig_firmware/capture/pair_loop.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace vantage {
namespace {

std::size_t bytes_a_side(cv::Size size) { return 3 * static_cast<std::size_t>(size.area()); }

}  // namespace

PairLoop::PairLoop(cv::Size size, std::chrono::seconds loop, const PulseGrid& pulses,
                   std::size_t most_bytes)
    : size_(size), loop_(loop) {
    const PulseGrid::Fraction rate = pulses.rate();
    if (size.empty() || loop.count() * rate.pulses % rate.seconds != 0) return;
    length_ = static_cast<std::size_t>(loop.count() * rate.pulses / rate.seconds);
    room_ = std::min(length_, most_bytes / (2 * bytes_a_side(size)));
    bytes_.resize(room_ * 2 * bytes_a_side(size));
}

std::chrono::nanoseconds PairLoop::folded(std::chrono::nanoseconds time) const {
    const std::chrono::nanoseconds rest = time % loop_;
    return rest < std::chrono::nanoseconds(0) ? rest + loop_ : rest;
}

cv::Mat3b PairLoop::place(std::size_t pair, int side) const {
    const std::size_t at = 2 * pair + static_cast<std::size_t>(side);
    return {size_.height, size_.width,
            reinterpret_cast<cv::Vec3b*>(bytes_.data() + at * bytes_a_side(size_))};
}

std::optional<PairLoop::Pair> PairLoop::find(std::chrono::nanoseconds time) const {
    const auto known = places_.find(folded(time).count());
    if (known == places_.end()) return std::nullopt;
    Pair pair;
    cv::cvtColor(place(known->second, 0), pair.left, cv::COLOR_RGB2RGBA);
    cv::cvtColor(place(known->second, 1), pair.right, cv::COLOR_RGB2RGBA);
    return pair;
}

void PairLoop::keep(std::chrono::nanoseconds time, const ColourImage& left,
                    const ColourImage& right) {
    if (places_.size() >= room_ || left.size() != size_ || right.size() != size_) return;
    const auto [known, is_new] = places_.try_emplace(folded(time).count(), places_.size());
    if (!is_new) return;
    cv::Mat3b left_place = place(known->second, 0), right_place = place(known->second, 1);
    cv::cvtColor(left, left_place, cv::COLOR_RGBA2RGB);
    cv::cvtColor(right, right_place, cv::COLOR_RGBA2RGB);
}

}  // namespace vantage
