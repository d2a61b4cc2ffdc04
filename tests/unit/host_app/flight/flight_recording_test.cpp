#include <cmath>

#include <gtest/gtest.h>

#include "host_app/flight/moves/move.h"
#include "tests/unit/host_app/flight/looking.h"

namespace vantage {
namespace {

/// A flight that turns, stops, dollies in and rises; with `rolls` it also rolls, as a tracked
/// camera.
FlightRecording hand_flight(double rate_hz, bool rolls) {
    FlightRecording flight;
    for (int i = 0; i < 20 * rate_hz; ++i) {
        const double t = i / rate_hz;
        OrbitView view;
        view.azimuth_rad = 0.8 * std::sin(0.5 * t) + 0.1 * std::sin(2.1 * t);
        view.elevation_rad = 0.2 + 0.15 * std::sin(0.7 * t + 1);
        view.distance_m = t < 8 ? 4 : 4 - 0.15 * (t - 8);
        view.pivot_m.y() = 1 + 0.02 * t;
        view.roll_rad = rolls ? 0.1 * std::sin(t) : 0;
        flight.push_back({100 + t, view, {}});
    }
    return flight;
}

void expect_within(const FlightRecording& flight, const Move& move, const FlightTolerance& most,
                   double factor = 1) {
    for (const FlightSample& sample : flight) {
        const Pose there = sample.view.world_from_camera();
        const Pose made = move.at(sample.time_s - flight.front().time_s).world_from_camera();
        EXPECT_LE((there.translation() - made.translation()).norm(), factor * most.shift_m + 1e-9);
        EXPECT_LE(Eigen::AngleAxisd(there.linear().transpose() * made.linear()).angle(),
                  factor * most.turn_rad + 1e-9);
    }
}

TEST(SimplifiedFlight, HasFewKeyframesWithinTheTolerance) {
    const FlightTolerance tolerance;
    for (const MovePath path : {MovePath::orbit, MovePath::free}) {
        const FlightRecording flight = hand_flight(50, path == MovePath::free);
        const SimplifiedFlight made = simplified(flight, tolerance, {}, path);
        EXPECT_LE(made.worst, 1);
        EXPECT_EQ(made.move.path(), path);
        EXPECT_NEAR(made.move.duration_s(), 19.98, 1e-9);
        EXPECT_LT(made.move.keyframes().size(), 100u) << "of 1000 samples";
        expect_within(flight, made.move, tolerance);
    }
}

TEST(SimplifiedFlight, NeedsMoreKeyframesForASmallerTolerance) {
    const FlightRecording flight = hand_flight(50, false);
    const auto keyframes = [&](double factor) {
        const FlightTolerance tolerance{0.01 * factor, 0.0017 * factor};
        return simplified(flight, tolerance, {}, MovePath::orbit).move.keyframes().size();
    };
    EXPECT_LT(keyframes(10), keyframes(1));
    EXPECT_LT(keyframes(1), keyframes(0.1));
}

TEST(SimplifiedFlight, KeepsACameraThatStands) {
    FlightRecording flight;
    for (int i = 0; i < 500; ++i) flight.push_back({0.02 * i, OrbitView{}, {}});
    EXPECT_EQ(simplified(flight, {}, {}, MovePath::orbit).move.keyframes().size(), 2u);
    flight.resize(1);
    EXPECT_EQ(simplified(flight, {}, {}, MovePath::orbit).move.keyframes().size(), 1u);
}

TEST(SimplifiedFlight, FollowsTimeInATakeThroughAFreeze) {
    FlightRecording flight;
    for (int i = 0; i < 500; ++i) {
        const double t = 0.02 * i;
        OrbitView view;
        view.azimuth_rad = 0.1 * t;
        flight.push_back({t, view, 30 + (t < 3 ? t : t < 6 ? 3 : t - 3)});
    }
    const SimplifiedFlight made = simplified(flight, {}, {}, MovePath::orbit);
    EXPECT_LT(made.move.keyframes().size(), 20u);
    for (const FlightSample& sample : flight)
        EXPECT_NEAR(*made.move.take_s_at(sample.time_s), *sample.take_s, 0.02 + 1e-9);
    flight[7].take_s.reset();
    EXPECT_FALSE(simplified(flight, {}, {}, MovePath::orbit).move.take_s_at(0))
        << "the flight was partly outside the take, so the move has no take times";
}

TEST(SimplifiedFlight, RaisesTheToleranceAtTheMaximumOfKeyframes) {
    FlightRecording flight;
    for (int i = 0; i < 4000; ++i) {
        OrbitView view;
        view.azimuth_rad = i % 2 ? 0.05 : 0.0;
        flight.push_back({0.02 * i, view, {}});
    }
    const SimplifiedFlight made = simplified(flight, {}, {}, MovePath::orbit);
    EXPECT_GT(made.worst, 1);
    EXPECT_LE(made.move.keyframes().size(), 1000u);
    expect_within(flight, made.move, {}, made.worst);
}

}  // namespace
}  // namespace vantage
