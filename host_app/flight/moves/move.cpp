#include "host_app/flight/moves/move.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>

#include "host_app/flight/flight_plan.h"

namespace vantage {
namespace {

using Channels = Eigen::Matrix<double, 8, 1>;

Channels orbit_channels(const OrbitView& view) {
    Channels c;
    c << view.pivot_m, view.azimuth_rad, view.elevation_rad, view.roll_rad,
        std::log(view.distance_m), view.field_of_view_rad;
    return c;
}

OrbitView orbit_view(const Channels& c) {
    OrbitView view;
    view.pivot_m = c.head<3>();
    view.azimuth_rad = c[3];
    view.elevation_rad = c[4];
    view.roll_rad = c[5];
    view.distance_m = std::exp(c[6]);
    view.field_of_view_rad = c[7];
    return view;
}

/// The three channels of the rotation are left 0.
Channels free_channels(const OrbitView& view) {
    Channels c;
    c << view.eye_m(), 0, 0, 0, std::log(view.distance_m), view.field_of_view_rad;
    return c;
}

/// A rotation as a vector along its axis, whose length is the angle.
Eigen::Vector3d vector_of(const Eigen::Quaterniond& turn) {
    const Eigen::AngleAxisd about(turn);
    return about.angle() * about.axis();
}

Eigen::Quaterniond turn_by(const Eigen::Vector3d& vector) {
    const double angle = vector.norm();
    if (angle == 0) return Eigen::Quaterniond::Identity();
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, vector / angle));
}

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

Move::Move(std::vector<MoveKeyframe> keyframes, bool loop, const FlightLimits& limits,
           MovePath path)
    : keyframes_(std::move(keyframes)), loop_(loop), limits_(limits), path_(path) {
    assert(!keyframes_.empty() && keyframes_.front().time_s == 0);
    assert(!loop_ || keyframes_.size() > 1);
    for (const MoveKeyframe& keyframe : keyframes_) {
        if (path_ == MovePath::orbit) {
            values_.push_back(orbit_channels(keyframe.view));
            continue;
        }
        values_.push_back(free_channels(keyframe.view));
        Eigen::Quaterniond turn(keyframe.view.world_from_camera().linear());
        if (!turns_.empty() && turn.dot(turns_.back()) < 0) turn.coeffs() *= -1;
        turns_.push_back(turn);
    }
    if (keyframes_.size() == 1)
        tangents_.emplace_back(Channels::Zero());
    else
        for (std::size_t i = 0; i < keyframes_.size(); ++i) tangents_.push_back(tangent(i));
}

double Move::duration_of(std::size_t segment) const {
    return keyframes_[segment + 1].time_s - keyframes_[segment].time_s;
}

Move::Channels Move::slope(std::size_t segment) const {
    Channels way = values_[segment + 1] - values_[segment];
    if (path_ == MovePath::free)
        way.segment<3>(rotation) = vector_of(turns_[segment].conjugate() * turns_[segment + 1]);
    return way / duration_of(segment);
}

Move::Channels Move::tangent(std::size_t keyframe) const {
    const std::size_t last = keyframes_.size() - 1;
    const bool at_seam = keyframe == 0 || keyframe == last;
    if (at_seam && !loop_) return Channels::Zero();
    const std::size_t before = keyframe == 0 ? last - 1 : keyframe - 1;
    const std::size_t after = keyframe == last ? 0 : keyframe;
    const Easing arriving = keyframes_[before].easing, leaving = keyframes_[after].easing;
    if (arriving == Easing::smooth && leaving == Easing::smooth) {
        const double h0 = duration_of(before), h1 = duration_of(after);
        return (h1 * slope(before) + h0 * slope(after)) / (h0 + h1);
    }
    // Where a smooth segment meets a linear one, it takes over the speed of that.
    if (arriving == Easing::smooth && leaving == Easing::linear) return slope(after);
    if (leaving == Easing::smooth && arriving == Easing::linear) return slope(before);
    return Channels::Zero();
}

Move::Place Move::place_of(double time_s) const {
    const double end_s = duration_s();
    if (loop_) time_s -= end_s * std::floor(time_s / end_s);
    time_s = std::clamp(time_s, 0.0, end_s);
    const auto after = std::upper_bound(
        keyframes_.begin() + 1, keyframes_.end() - 1, time_s,
        [](double time, const MoveKeyframe& keyframe) { return time < keyframe.time_s; });
    const auto i = static_cast<std::size_t>(after - keyframes_.begin()) - 1;
    return {i, (time_s - keyframes_[i].time_s) / duration_of(i)};
}

Eigen::Quaterniond Move::turn_at(const Place& place) const {
    const auto& [i, s] = place;
    const Eigen::Quaterniond &a = turns_[i], &b = turns_[i + 1];
    switch (keyframes_[i].easing) {
        case Easing::smooth:
            break;
        case Easing::linear:
            return a.slerp(s, b);
        case Easing::ease:
            return a.slerp(eased(s), b);
        case Easing::cut:
            return s < 1 ? a : b;
    }
    // De Casteljau's construction of a Bezier curve on the sphere.
    const double third_s = duration_of(i) / 3;
    const Eigen::Quaterniond from_a = a * turn_by(third_s * tangents_[i].segment<3>(rotation));
    const Eigen::Quaterniond to_b = b * turn_by(-third_s * tangents_[i + 1].segment<3>(rotation));
    const Eigen::Quaterniond middle = from_a.slerp(s, to_b);
    const Eigen::Quaterniond first = a.slerp(s, from_a).slerp(s, middle);
    return first.slerp(s, middle.slerp(s, to_b.slerp(s, b)));
}

OrbitView Move::at(double time_s) const {
    if (keyframes_.size() == 1) return keyframes_.front().view;
    const Place place = place_of(time_s);
    const auto& [i, s] = place;
    const double h = duration_of(i);
    const Channels &a = values_[i], &b = values_[i + 1];
    // Hermite basis on [0, 1].
    Channels value = a + eased(s) * (b - a);
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
    if (path_ == MovePath::orbit) return constrained(orbit_view(value), limits_);
    CameraState camera;
    camera.world_from_camera.linear() = turn_at(place).toRotationMatrix();
    camera.world_from_camera.translation() = value.head<3>();
    camera.world_from_camera.translation().y() =
        std::max(value.y(), std::min(limits_.min_eye_height_m, std::min(a.y(), b.y())));
    camera.focus_m = std::exp(value[6]);
    camera.field_of_view_rad =
        std::clamp(value[7], limits_.min_field_of_view_rad, limits_.max_field_of_view_rad);
    return orbit_view_of(camera, keyframes_[i].view.azimuth_rad);
}

std::optional<double> Move::take_s_at(double time_s) const {
    if (!keyframes_.front().take_s) return std::nullopt;
    if (keyframes_.size() == 1) return keyframes_.front().take_s;
    const auto& [i, s] = place_of(time_s);
    const double from_s = *keyframes_[i].take_s, to_s = *keyframes_[i + 1].take_s;
    return from_s + s * (to_s - from_s);
}

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

std::vector<UncoveredPart> uncovered_parts(const Move& move, const Corridor& corridor) {
    constexpr double step_s = 0.1;
    std::vector<UncoveredPart> parts;
    bool was_beyond = false;
    const int steps = static_cast<int>(std::ceil(move.duration_s() / step_s));
    for (int i = 0; i <= steps; ++i) {
        const double time_s = std::min(i * step_s, move.duration_s());

        const Coverage coverage = corridor.of(move.at(time_s).camera());
        const bool is_beyond = Corridor::place_of(coverage.share) == CorridorPlace::beyond;
        if (is_beyond && !was_beyond) parts.push_back({time_s, time_s, coverage});
        if (is_beyond) {
            parts.back().to_s = time_s;
            if (coverage.share < parts.back().least.share) parts.back().least = coverage;
        }
        was_beyond = is_beyond;
    }
    return parts;
}

namespace {

double deviation(const FlightSample& sample, const Move& move, double time_s,
                 const FlightTolerance& tolerance) {
    const CameraState there = sample.view.camera(), made = move.at(time_s).camera();
    const double turn_rad = Eigen::AngleAxisd(there.world_from_camera.linear().transpose() *
                                              made.world_from_camera.linear())
                                .angle();
    const double shift_m =
        (there.world_from_camera.translation() - made.world_from_camera.translation()).norm();
    const double zoom_rad = std::abs(there.field_of_view_rad - made.field_of_view_rad);
    const double take_s = sample.take_s ? std::abs(*sample.take_s - *move.take_s_at(time_s)) : 0;
    return std::max({shift_m / tolerance.shift_m, turn_rad / tolerance.turn_rad,
                     zoom_rad / tolerance.turn_rad, take_s / tolerance.take_s});
}

Move move_through(const FlightRecording& flight, const std::set<std::size_t>& chosen,
                  const FlightLimits& limits, MovePath path) {
    std::vector<MoveKeyframe> keyframes;
    for (const std::size_t i : chosen)
        keyframes.push_back({flight[i].time_s - flight.front().time_s, flight[i].view,
                             Easing::smooth, flight[i].take_s});
    return {std::move(keyframes), false, limits, path};
}

}  // namespace

SimplifiedFlight simplified(const FlightRecording& flight, const FlightTolerance& tolerance,
                            const FlightLimits& limits, MovePath path) {
    assert(!flight.empty());
    FlightRecording samples = flight;
    const bool has_take = std::all_of(samples.begin(), samples.end(),
                                      [](const FlightSample& each) { return each.take_s; });
    if (!has_take)
        for (FlightSample& sample : samples) sample.take_s.reset();
    for (double allowed = 1;; allowed *= 2) {
        std::set<std::size_t> chosen{0, samples.size() - 1};
        for (;;) {
            Move move = move_through(samples, chosen, limits, path);
            double worst_of_all = 0;
            std::vector<std::size_t> more;
            for (auto from = chosen.begin(); std::next(from) != chosen.end(); ++from) {
                std::size_t worst_at = *from;
                double worst = 0;
                for (std::size_t i = *from + 1; i < *std::next(from); ++i) {
                    const double off = deviation(
                        samples[i], move, samples[i].time_s - samples.front().time_s, tolerance);
                    if (off > worst) {
                        worst = off;
                        worst_at = i;
                    }
                }
                if (worst > allowed) more.push_back(worst_at);
                worst_of_all = std::max(worst_of_all, worst);
            }
            if (more.empty()) return {std::move(move), worst_of_all};
            chosen.insert(more.begin(), more.end());
            if (chosen.size() > most_keyframes) break;
        }
    }
}

}  // namespace vantage
