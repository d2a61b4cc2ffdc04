#include "host_app/flight/moves/move_edit.h"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

/// Shortest time between two keyframes.
constexpr double min_gap_s = 0.05;

Move rebuilt(const Move& move, std::vector<MoveKeyframe> keyframes) {
    const double start_s = keyframes.front().time_s;
    for (MoveKeyframe& keyframe : keyframes) keyframe.time_s -= start_s;
    const bool loops = move.loops() && keyframes.size() > 1 &&
                       is_same_shot(keyframes.front().view, keyframes.back().view);
    return {std::move(keyframes), loops, move.limits(), move.path()};
}

}  // namespace

Move appended(const std::optional<Move>& move, const OrbitView& view, std::optional<double> take_s,
              double after_s, const FlightLimits& limits) {
    if (!move) return {{{0, view, Easing::smooth, take_s}}, false, limits};
    std::vector<MoveKeyframe> keyframes = move->keyframes();
    const MoveKeyframe& last = keyframes.back();
    if (!last.take_s) take_s.reset();
    if (last.take_s && !take_s) take_s = last.take_s;
    const double passed_s = take_s ? *take_s - *last.take_s : 0;
    keyframes.push_back(
        {last.time_s + (passed_s > min_gap_s ? passed_s : after_s), view, last.easing, take_s});
    return rebuilt(*move, std::move(keyframes));
}

Move with_view_at(const Move& move, double time_s, OrbitView view, std::optional<double> take_s) {
    std::vector<MoveKeyframe> keyframes = move.keyframes();
    const OrbitView before = move.at(time_s);
    view.azimuth_rad = nearest_turn(view.azimuth_rad, before.azimuth_rad);
    view.roll_rad = nearest_turn(view.roll_rad, before.roll_rad);
    MoveKeyframe& nearest = keyframes[nearest_keyframe(move, time_s)];
    if (std::abs(nearest.time_s - time_s) < min_gap_s) {
        nearest.view = view;
        if (nearest.take_s && take_s) nearest.take_s = take_s;
        return rebuilt(move, std::move(keyframes));
    }
    const auto after = std::find_if(keyframes.begin(), keyframes.end(),
                                    [&](const auto& keyframe) { return keyframe.time_s > time_s; });
    MoveKeyframe fresh{time_s, view, Easing::smooth, move.take_s_at(time_s)};
    if (fresh.take_s && take_s) fresh.take_s = take_s;
    if (after != keyframes.begin()) fresh.easing = (after - 1)->easing;
    keyframes.insert(after, fresh);
    return rebuilt(move, std::move(keyframes));
}

std::size_t nearest_keyframe(const Move& move, double time_s) {
    const std::vector<MoveKeyframe>& keyframes = move.keyframes();
    const auto nearest =
        std::min_element(keyframes.begin(), keyframes.end(), [&](const auto& a, const auto& b) {
            return std::abs(a.time_s - time_s) < std::abs(b.time_s - time_s);
        });
    return static_cast<std::size_t>(nearest - keyframes.begin());
}

std::optional<Move> without_keyframe(const Move& move, std::size_t keyframe) {
    std::vector<MoveKeyframe> keyframes = move.keyframes();
    if (keyframes.size() == 1) return std::nullopt;
    keyframes.erase(keyframes.begin() + static_cast<std::ptrdiff_t>(keyframe));
    return rebuilt(move, std::move(keyframes));
}

Move retimed(const Move& move, std::size_t keyframe, double later_s) {
    std::vector<MoveKeyframe> keyframes = move.keyframes();
    if (keyframe == 0) return move;
    const double gap_s = keyframes[keyframe].time_s - keyframes[keyframe - 1].time_s;
    later_s = std::max(later_s, std::min(min_gap_s, gap_s) - gap_s);
    for (std::size_t i = keyframe; i < keyframes.size(); ++i) keyframes[i].time_s += later_s;
    return rebuilt(move, std::move(keyframes));
}

}  // namespace vantage
