#include "host_app/flight/moves/flight_recording.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>

#include "host_app/flight/flight_plan.h"

namespace vantage {
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
