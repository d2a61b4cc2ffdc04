#include "host_app/flight/move.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace vantage {
namespace {

Eigen::Matrix<double, 7, 1> to_channels(const OrbitView& view) {
    Eigen::Matrix<double, 7, 1> c;
    c << view.pivot_m, view.azimuth_rad, view.elevation_rad, std::log(view.distance_m),
        view.field_of_view_rad;
    return c;
}

OrbitView to_view(const Eigen::Matrix<double, 7, 1>& c) {
    OrbitView view;
    view.pivot_m = c.head<3>();
    view.azimuth_rad = c[3];
    view.elevation_rad = c[4];
    view.distance_m = std::exp(c[5]);
    view.field_of_view_rad = c[6];
    return view;
}

}  // namespace

Move::Move(std::vector<MoveKeyframe> keyframes, bool loop, const FlightLimits& limits)
    : keyframes_(std::move(keyframes)), loop_(loop), limits_(limits) {
    assert(keyframes_.size() >= 2 && keyframes_.front().time_s == 0);
    for (const MoveKeyframe& keyframe : keyframes_) values_.push_back(to_channels(keyframe.view));
    for (std::size_t i = 0; i < keyframes_.size(); ++i) tangents_.push_back(tangent(i));
}

Move::Channels Move::slope(std::size_t segment) const {
    return (values_[segment + 1] - values_[segment]) /
           (keyframes_[segment + 1].time_s - keyframes_[segment].time_s);
}

Move::Channels Move::tangent(std::size_t keyframe) const {
    const std::size_t last = keyframes_.size() - 1;
    const bool at_seam = keyframe == 0 || keyframe == last;
    if (at_seam && !loop_) return Channels::Zero();
    const std::size_t before = keyframe == 0 ? last - 1 : keyframe - 1;
    const std::size_t after = keyframe == last ? 0 : keyframe;
    const Easing arriving = keyframes_[before].easing, leaving = keyframes_[after].easing;
    if (arriving == Easing::smooth && leaving == Easing::smooth) {
        const double h0 = keyframes_[before + 1].time_s - keyframes_[before].time_s;
        const double h1 = keyframes_[after + 1].time_s - keyframes_[after].time_s;
        return (h1 * slope(before) + h0 * slope(after)) / (h0 + h1);
    }
    // A smooth part takes up the speed of the straight part that it meets.
    if (arriving == Easing::smooth && leaving == Easing::linear) return slope(after);
    if (leaving == Easing::smooth && arriving == Easing::linear) return slope(before);
    return Channels::Zero();
}

OrbitView Move::at(double time_s) const {
    const double end_s = duration_s();
    if (loop_) time_s -= end_s * std::floor(time_s / end_s);
    time_s = std::clamp(time_s, 0.0, end_s);
    const auto after = std::upper_bound(
        keyframes_.begin() + 1, keyframes_.end() - 1, time_s,
        [](double time, const MoveKeyframe& keyframe) { return time < keyframe.time_s; });
    const auto i = static_cast<std::size_t>(after - keyframes_.begin()) - 1;
    const double h = keyframes_[i + 1].time_s - keyframes_[i].time_s;
    const double s = (time_s - keyframes_[i].time_s) / h;
    const Channels &a = values_[i], &b = values_[i + 1];
    // Hermite's basis on [0, 1].
    const double to_b = s * s * (3 - 2 * s);
    Channels value = a + to_b * (b - a);
    switch (keyframes_[i].easing) {
        case Easing::smooth:
            value +=
                h * (s * (1 - s) * (1 - s) * tangents_[i] - s * s * (1 - s) * tangents_[i + 1]);
            break;
        case Easing::linear:
            value = a + s * (b - a);
            break;
        case Easing::ease:
            break;
        case Easing::cut:
            value = s < 1 ? a : b;
            break;
    }
    return constrained(to_view(value), limits_);
}

}  // namespace vantage
