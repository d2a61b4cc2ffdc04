#include "host_app/control/flight_controls.h"

#include <thread>
#include <tuple>

#include <gtest/gtest.h>

#include "tests/unit/host_app/flight/given_commands.h"
#include "tests/unit/host_app/flight/ring_of_rigs.h"
#include "tests/unit/host_app/hid/scripted_port.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

TEST(OperatorInputBox, AddsUpInputAndKeepsTheEarliestTime) {
    OperatorInputBox box;
    EXPECT_FALSE(box.take().since);
    const MonotonicTime start{1h};
    box.put({}, start);
    EXPECT_FALSE(box.take().since) << "there was no input";
    box.put({.orbit_azimuth_rad = 0.1}, start + 1ms);
    box.put({.orbit_azimuth_rad = 0.2, .commands = {command::ToggleHold{}}}, start + 5ms);
    const OperatorInputBox::Taken taken = box.take();
    EXPECT_NEAR(taken.input.orbit_azimuth_rad, 0.3, 1e-12);
    EXPECT_TRUE(taken.input.find<command::ToggleHold>());
    EXPECT_EQ(taken.since, start + 1ms);
    EXPECT_FALSE(box.take().input.is_any()) << "every input is taken once";
}

TEST(OperatorInputBox, KeepsTheOrderOfCommands) {
    OperatorInputBox box;
    const MonotonicTime start{1h};
    EXPECT_TRUE(box.put({.commands = {command::ToggleOutput{1}}}, start));
    EXPECT_TRUE(
        box.put({.orbit_azimuth_rad = 0.1, .commands = {command::ToggleOutput{2}}}, start + 1ms));
    EXPECT_TRUE(box.put({.commands = {ReplayCall{ReplayAction::make_clip}}}, start + 2ms));
    EXPECT_TRUE(box.put({.orbit_azimuth_rad = 0.2, .commands = {command::MarkIn{}}}, start + 3ms));
    const OperatorInputBox::Taken taken = box.take();
    EXPECT_NEAR(taken.input.orbit_azimuth_rad, 0.3, 1e-12);
    EXPECT_EQ(taken.since, start);
    ASSERT_EQ(taken.input.commands.size(), 4u);
    const auto output = [&](std::size_t i) {
        return std::get<command::ToggleOutput>(std::get<SessionCommand>(taken.input.commands[i]));
    };
    EXPECT_EQ(output(0).number, 1);
    EXPECT_EQ(output(1).number, 2);
    EXPECT_TRUE(std::holds_alternative<ReplayCall>(taken.input.commands[2]));
    EXPECT_TRUE(std::holds_alternative<TransportCommand>(taken.input.commands[3]));
}

TEST(OperatorInputBox, DropsCommandsBeyondItsBoundButNoAxes) {
    OperatorInputBox box;
    std::size_t dropped = 0;
    for (int i = 0; i < 1000; ++i)
        dropped +=
            box.put({.orbit_azimuth_rad = 0.001, .commands = {command::ToggleHold{}}}, {}) ? 0 : 1;
    EXPECT_EQ(dropped, 1000 - OperatorInputBox::max_commands);
    const FlightInput input = box.take().input;
    EXPECT_EQ(input.commands.size(), OperatorInputBox::max_commands);
    EXPECT_NEAR(input.orbit_azimuth_rad, 1.0, 1e-9);
    EXPECT_FALSE(box.take().since);
}

TEST(FlightControlsInThePast, ReturningToLiveDoesNotMoveTheCamera) {
    FlightControls controls({.plan = {}, .pulse_rate_hz = 25, .has_past = true}, nullptr,
                            [](int number) -> std::optional<OrbitView> {
                                OrbitView view;
                                view.azimuth_rad = 0.1 * number;
                                return view;
                            });
    double time_s = 0;
    Pose last = controls.step(time_s, {}).view.camera().world_from_camera;
    double fastest = 0, at_live = 0;
    const auto fly = [&](const FlightInput& input, std::optional<double> pulse) {
        controls.operator_input().put(input, {});
        const CameraStep step = controls.step(time_s += 0.04, pulse);
        const Pose pose = step.view.camera().world_from_camera;
        const double way = (pose.matrix() - last.matrix()).norm();
        last = pose;
        fastest = std::max(fastest, way);
        return std::pair(way, has<command::ToLive>(step.time));
    };
    fly({.commands = {command::StepFrames{-10}}}, {});
    fly({.commands = {ReplayCall{ReplayAction::play_clip}}}, 90);
    // The camera is still on its flight to shot 3 when the transport returns to live.
    (void)controls.fly_to_shot(3);
    for (int i = 0; i < 10; ++i) fly({.orbit_azimuth_rad = 0}, 91 + i);
    EXPECT_GT(fastest, 0) << "it flies";
    const double before = fastest;
    bool is_live_asked = false;
    std::tie(at_live, is_live_asked) = fly({.commands = {command::ToLive{}}}, 102);
    EXPECT_TRUE(is_live_asked);
    EXPECT_LE(at_live, 1.2 * before) << "the flight goes on";
    for (int i = 0; i < 100; ++i) fly({}, {});
    EXPECT_LT(fly({.commands = {command::ToLive{}}}, {}).first, 1e-12)
        << "and a camera at rest stays";
}

TEST(FlightControlsInThePast, ShotWithoutADurationIsReachedInTheSameStep) {
    FlightPlan plan;
    OrbitView there;
    there.azimuth_rad = 0.7;
    plan.book.shots[1] = Shot{"side", there, 0};
    FlightControls controls({.plan = plan, .pulse_rate_hz = 25, .has_past = true}, nullptr,
                            [](int) { return std::nullopt; });
    controls.step(0, {});
    EXPECT_NEAR(controls.fly_to_shot(2).view.azimuth_rad, 0.7, 1e-9);
    EXPECT_NEAR(controls.step(0.04, {}).view.azimuth_rad, 0.7, 1e-9);
}

FlightPlan frozen_flight() {
    OrbitView end;
    end.azimuth_rad = 1;
    FlightPlan plan;
    plan.move = Move({{0, OrbitView{}, Easing::linear, 2.0},
                      {1, end, Easing::linear, 2.0},
                      {2, end, Easing::linear, 4.0}},
                     false);
    return plan;
}

TEST(FlightControlsInATake, MoveSetsTheTime) {
    FlightControls controls(
        {.plan = frozen_flight(), .pulse_rate_hz = 25, .has_past = true, .take_begin = 1000},
        nullptr, [](int) { return std::nullopt; });
    EXPECT_EQ(controls.step(0, 1000).time.at_pulse, 1050);
    EXPECT_EQ(controls.step(0.5, 1050).time.at_pulse, 1050) << "frozen";
    EXPECT_NEAR(*controls.step(1.5, 1050).time.at_pulse, 1075, 1e-9);
    // Holding the time pauses the move, and stepping leaves it.
    controls.operator_input().put({.commands = {command::ToggleHold{}}}, {});
    const CameraStep held = controls.step(1.6, 1075);
    EXPECT_FALSE(has<command::ToggleHold>(held.time));
    EXPECT_NEAR(*held.time.at_pulse, 1075, 1e-9);
    EXPECT_NEAR(*controls.step(1.9, 1075).time.at_pulse, 1075, 1e-9);
    controls.operator_input().put({.commands = {command::StepFrames{1}}}, {});
    EXPECT_FALSE(controls.step(2, 1075).time.at_pulse);
}

TEST(FlightControlsInATake, TheWheelScrubsFlightAndTimeBothWays) {
    FlightControls controls(
        {.plan = frozen_flight(), .pulse_rate_hz = 25, .has_past = true, .take_begin = 1000},
        nullptr, [](int) { return std::nullopt; });
    double time_s = 1.5;
    controls.step(time_s, 1075);
    const auto scrubbed = [&](double steps) {
        controls.operator_input().put({.wheel_steps = steps}, {});
        for (int i = 0; i < 100; ++i) controls.step(time_s += 0.02, 1075);
        const CameraStep step = controls.step(time_s += 0.02, 1075);
        return std::pair(step.view.azimuth_rad, *step.time.at_pulse);
    };
    const auto [back_rad, back] = scrubbed(-10);
    EXPECT_NEAR(back_rad, 0.5, 1e-6) << "a step is 0.1 s";
    EXPECT_NEAR(back, 1050, 1e-6);
    const auto [on_rad, on] = scrubbed(7);
    EXPECT_NEAR(on_rad, 1, 1e-6);
    EXPECT_NEAR(on, 1060, 1e-6);
}

TEST(FlightControlsInATake, MoveDoesNotSetTheTimeOfALiveStage) {
    FlightControls controls({.plan = frozen_flight(), .pulse_rate_hz = 25, .has_past = true},
                            nullptr, [](int) { return std::nullopt; });
    EXPECT_FALSE(controls.step(0.5, {}).time.at_pulse);
}

TEST(FlightControlsRecording, KeepsEveryStepWithItsTimeInTheTake) {
    FlightControls controls({.plan = {}, .pulse_rate_hz = 25, .has_past = true, .take_begin = 1000},
                            nullptr, [](int) { return std::nullopt; });
    controls.operator_input().put({.commands = {command::ToggleRecording{}}}, {});
    for (int i = 0; i < 10; ++i) {
        controls.operator_input().put({.orbit_azimuth_rad = 0.1}, {});
        controls.step(5 + 0.02 * i, 1000 + i);
        EXPECT_TRUE(controls.lines().is_recording);
    }
    EXPECT_TRUE(controls.take_requests().flight.empty()) << "the recording goes on";
    controls.operator_input().put({.commands = {command::ToggleRecording{}}}, {});
    controls.step(5.2, 1010);
    const FlightRecording flight = controls.take_requests().flight;
    ASSERT_EQ(flight.size(), 10u);
    EXPECT_EQ(flight[0].time_s, 5);
    EXPECT_NEAR(*flight[9].take_s, 9 / 25.0, 1e-12);
    EXPECT_GT(flight[9].view.azimuth_rad, flight[1].view.azimuth_rad);
    EXPECT_TRUE(controls.take_requests().flight.empty()) << "once";
    controls.keep_flight(Move({{0, OrbitView{}}, {1, OrbitView{}}}, false));
    controls.step(5.3, 1010);
    EXPECT_EQ(controls.lines().keyframes, 2u);
}

TEST(FlightControlsPivot, IsPickedByTheSession) {
    FlightControls controls({.plan = {}, .pulse_rate_hz = 25}, nullptr,
                            [](int) { return std::nullopt; });
    controls.operator_input().put({.commands = {command::PickPivot{{0.25, 0.75}}}}, {});
    controls.step(0, {});
    const SessionRequests requests = controls.take_requests();
    ASSERT_EQ(requests.commands.size(), 1u);
    EXPECT_EQ(std::get<command::PickPivot>(requests.commands[0]).place,
              Eigen::Vector2d(0.25, 0.75));
    EXPECT_TRUE(controls.take_requests().commands.empty()) << "once";
    controls.operator_input().put({.commands = {command::LookAt{Eigen::Vector3d(1, 1.2, -1)}}}, {});
    for (int i = 1; i < 200; ++i) controls.step(0.02 * i, {});
    EXPECT_TRUE(controls.step(4.1, {}).view.pivot_m.isApprox(Eigen::Vector3d(1, 1.2, -1), 1e-6));
}

TEST(FlightControlsPivot, FollowsUntilInputMovesIt) {
    FlightControls controls({.plan = {}, .pulse_rate_hz = 25}, nullptr,
                            [](int) { return std::nullopt; });
    double time_s = 0;
    const auto pass = [&] {
        for (int i = 0; i < 200; ++i) controls.step(time_s += 0.02, {});
        return controls.step(time_s += 0.02, {}).view.pivot_m;
    };
    controls.follow({1, {1, 1, 0}});
    EXPECT_NEAR(pass().x(), 0, 1e-9) << "following is off";
    controls.operator_input().put({.commands = {command::ToggleFollow{}}}, {});
    pass();
    EXPECT_TRUE(controls.lines().is_following);
    ASSERT_EQ(controls.lines().following.size(), 1u);
    controls.follow({controls.lines().following[0].camera, {1, 1, 0}});
    EXPECT_NEAR(pass().x(), 1, 1e-6);
    controls.operator_input().put({.orbit_azimuth_rad = 0.3}, {});
    pass();
    EXPECT_TRUE(controls.lines().is_following) << "an orbit keeps the pivot";
    controls.operator_input().put({.pan_right_widths = 0.1}, {});
    const double panned = pass().x();
    EXPECT_FALSE(controls.lines().is_following);
    controls.follow({1, {-1, 1, 0}});
    EXPECT_NEAR(pass().x(), panned, 1e-9);
}

TEST(FlightControlsRecording, EndsWithTheShow) {
    FlightControls controls({.plan = {}, .pulse_rate_hz = 25}, nullptr,
                            [](int) { return std::nullopt; });
    controls.operator_input().put({.commands = {command::ToggleRecording{}}}, {});
    controls.step(0.1, {});
    controls.end_recording();
    EXPECT_EQ(controls.take_requests().flight.size(), 1u);
}

/// Flight controls with a simulated wheel.
class FlightControlsTest : public testing::Test {
  protected:
    FlightControlsTest() {
        plug_in();
        step();
    }

    static FlightPlan start() {
        FlightPlan plan;
        plan.start = OrbitView{.distance_m = 4.5, .field_of_view_rad = 1.0};
        return plan;
    }
    static std::optional<OrbitView> rig_view(int number) {
        if (number != 1) return std::nullopt;
        OrbitView view;
        view.azimuth_rad = 0.3;
        return view;
    }

    void plug_in() {
        wheel_ = std::make_shared<ScriptedDevice>(JogPlace{
            .path = "/dev/hidraw0", .id = {0x0b33, 0x0020}, .name = "ShuttleXpress", .serial = {}});
        reports_ = 0;
        sockets_.plug(wheel_);
        send({0, detent_, 0, 0, 0});  // where the wheel stands
    }
    void unplug() {
        sockets_.unplug(wheel_);
        ASSERT_TRUE(wait_for([](const auto& devices) { return devices.empty(); }));
    }
    void turn(int detents) {
        detent_ = static_cast<std::uint8_t>(detent_ + detents);
        send({0, detent_, 0, 0, 0});
    }
    void push_button(int number) {
        send({0, detent_, 0, static_cast<std::uint8_t>(0x10 << (number - 1)), 0});
        send({0, detent_, 0, 0, 0});
    }
    /// Sends a report and waits until it was read. The second copy changes nothing, and is counted
    /// only after the first one was handled.
    void send(const Bytes& report) {
        wheel_->send(report);
        wheel_->send(report);
        reports_ += 2;
        ASSERT_TRUE(wait_for([&](const auto& devices) {
            return devices.size() == 1 && devices[0].reports == reports_;
        }));
    }
    template <class Condition>
    bool wait_for(Condition condition) {
        for (int i = 0; i < 5000; ++i) {
            if (condition(deck_.devices())) return true;
            std::this_thread::sleep_for(2ms);
        }
        return false;
    }

    /// The next step, `after_s` after the last one.
    CameraStep step(double after_s = 0.02) {
        time_s_ += after_s;
        const CameraStep step = controls_.step(time_s_, std::nullopt);
        azimuth_rad_ = step.view.azimuth_rad;
        return step;
    }

    ScriptedSockets sockets_;
    JogDevices deck_{
        sockets_.bus(), load_wheel_profiles(), {.raw_reports = false, .look_every = 5ms}};
    FlightControls controls_{
        {.plan = start(), .pulse_rate_hz = 25, .has_past = true}, &deck_, rig_view};
    std::shared_ptr<ScriptedDevice> wheel_;
    std::uint8_t detent_ = 7;
    std::uint64_t reports_ = 0;
    double time_s_ = 0, azimuth_rad_ = 0;
};

TEST_F(FlightControlsTest, HoldsItsPoseWithoutInput) {
    const double before_rad = azimuth_rad_;
    for (int i = 0; i < 20; ++i) {
        const CameraStep still = step();
        EXPECT_FALSE(still.input);
        EXPECT_FALSE(still.next_synthesiser || still.toggle_source_map);
        EXPECT_TRUE(still.time.commands.empty());
        EXPECT_EQ(still.time.pulses, 0);
    }
    EXPECT_EQ(azimuth_rad_, before_rad);
}

TEST_F(FlightControlsTest, WheelTurnIsInTheNextStep) {
    const double before_rad = azimuth_rad_;
    const MonotonicTime before = MonotonicClock::now();
    turn(3);
    const CameraStep turned = step();
    EXPECT_GT(std::abs(azimuth_rad_ - before_rad), 1e-3);
    ASSERT_TRUE(turned.input);
    EXPECT_GE(*turned.input, before);
    EXPECT_LE(*turned.input, MonotonicClock::now());
    EXPECT_FALSE(step().input) << "once only";
}

TEST_F(FlightControlsTest, ShuttleMovesEveryStep) {
    send({3, detent_, 0, 0, 0});
    double last_rad = azimuth_rad_;
    for (int i = 0; i < 5; ++i) {
        step();
        EXPECT_GT(std::abs(azimuth_rad_ - last_rad), 1e-6) << "step " << i;
        last_rad = azimuth_rad_;
    }
}

TEST_F(FlightControlsTest, FreezeButtonHoldsTheNextStep) {
    push_button(3);
    EXPECT_TRUE(has<command::ToggleHold>(step().time));
    EXPECT_FALSE(has<command::ToggleHold>(step().time));
}

TEST_F(FlightControlsTest, UnpluggedWheelStopsAndWorksAgainWhenItIsBack) {
    turn(3);
    send({7, detent_, 0, 0, 0});
    step();
    unplug();
    step(5);
    const double held_rad = azimuth_rad_;
    step(5);
    EXPECT_NEAR(azimuth_rad_, held_rad, 1e-9)
        << "the ring was at its stop when the cable was pulled";
    plug_in();
    step();
    EXPECT_NEAR(azimuth_rad_, held_rad, 1e-9)
        << "a wheel that is plugged in again gives no input yet";
    turn(-2);
    step();
    EXPECT_GT(std::abs(azimuth_rad_ - held_rad), 1e-3);
}

TEST_F(FlightControlsTest, WheelGoesThroughThePastPulseByPulse) {
    push_button(4);
    step();
    ASSERT_NE(controls_.lines().wheel.find("past"), std::string::npos) << controls_.lines().wheel;
    const double before_rad = azimuth_rad_;
    turn(-3);
    EXPECT_EQ(step().time.pulses, -3);
    EXPECT_EQ(step().time.pulses, 0);
    send({5, detent_, 0, 0, 0});
    double pulses = 0;
    for (int i = 0; i < 50; ++i) pulses += step().time.shuttle_pulses;
    EXPECT_GT(pulses, 1) << "the ring plays forward";
    EXPECT_LE(pulses, 2 * 25 + 1e-9) << "at most at twice the rate of the stage";
    EXPECT_EQ(azimuth_rad_, before_rad) << "the camera stays";
}

TEST_F(FlightControlsTest, OneStepTakesMouseAndWheel) {
    turn(1);
    const MonotonicTime earlier = MonotonicClock::now() - 1s;
    controls_.operator_input().put(
        {.commands = {command::ToggleHold{}, command::NextSynthesiser{}, command::ToLive{},
                      command::ToggleSourceMap{}, command::StepFrames{-2}}},
        earlier);
    const double before_rad = azimuth_rad_;
    const CameraStep both = step();
    EXPECT_TRUE(both.next_synthesiser && both.toggle_source_map);
    ASSERT_EQ(both.time.commands.size(), 3u);
    const auto transport = [&](std::size_t i) {
        return std::get<TransportCommand>(both.time.commands[i]);
    };
    EXPECT_TRUE(std::holds_alternative<command::ToggleHold>(transport(0)));
    EXPECT_TRUE(std::holds_alternative<command::ToLive>(transport(1)));
    EXPECT_EQ(std::get<command::StepFrames>(transport(2)).frames, -2);
    EXPECT_GT(std::abs(azimuth_rad_ - before_rad), 1e-4);
    EXPECT_EQ(both.input, earlier) << "the earlier of the two inputs";
}

TEST_F(FlightControlsTest, WheelMovesNothingWhileItsMapIsOpen) {
    send({5, detent_, 0, 0, 0});
    step();
    controls_.wheels().serve_desk();
    controls_.operator_input().put({.commands = {command::ToggleJogMap{}}}, {});
    step();
    for (int i = 0; i < 100; ++i) step();  // the camera comes to rest
    const double before_rad = azimuth_rad_;
    turn(5);
    push_button(3);
    push_button(1);
    for (int i = 0; i < 20; ++i) {
        const CameraStep still = step();
        EXPECT_FALSE(has<command::ToggleHold>(still.time) || still.input);
    }
    EXPECT_NEAR(azimuth_rad_, before_rad, 1e-6) << "not even by the ring that is held";
    EXPECT_NE(controls_.lines().wheel.find("moves nothing"), std::string::npos);
    controls_.wheels().obey({WheelCall::Action::assign, 0, "mark_in"});
    controls_.wheels().obey({WheelCall::Action::close});
    EXPECT_NE((step(), controls_.lines().wheel).find("unsaved changes"), std::string::npos);
    push_button(1);
    EXPECT_TRUE(has<command::MarkIn>(step().time)) << "and it flies to no shot";
}

TEST_F(FlightControlsTest, FliesToTheViewOfARig) {
    push_button(1);
    for (int i = 0; i < 500; ++i) step();
    EXPECT_NEAR(azimuth_rad_, 0.3, 0.01);
    push_button(2);
    for (int i = 0; i < 100; ++i) step();
    EXPECT_NEAR(azimuth_rad_, 0.3, 0.01) << "there is no second rig";
}

TEST_F(FlightControlsTest, ReportsTheTargetOfTheWheel) {
    step();
    EXPECT_NE(controls_.lines().wheel.find("drives the orbit"), std::string::npos)
        << controls_.lines().wheel;
    EXPECT_FALSE(controls_.lines().move_progress);
    unplug();
    step();
    EXPECT_EQ(controls_.lines().wheel, "");
}

TEST(FlightControlsWithoutDevices, FlyThePlannedMove) {
    FlightPlan plan;
    OrbitView end = *plan.start;
    end.azimuth_rad = 0.4;
    plan.move = Move({{0, *plan.start, Easing::linear}, {2, end, Easing::linear}}, false);
    FlightControls controls({.plan = plan}, nullptr, [](int) { return std::nullopt; });
    EXPECT_NEAR(controls.step(1, std::nullopt).view.azimuth_rad, 0.2, 1e-9);
    EXPECT_NEAR(*controls.lines().move_progress, 0.5, 1e-9);
    EXPECT_NEAR(controls.step(3, std::nullopt).view.azimuth_rad, 0.4, 1e-9);
    EXPECT_EQ(controls.lines().wheel, "");
}

/// The status after input has turned the camera steadily, with two rigs at 10 degrees.
FlightControls::Lines lines_after_a_turn(bool free_flight, double turn_deg) {
    FlightPlan plan;
    plan.start = view_at(0);
    const auto corridor = corridor_of({-10, 10});
    FlightControls controls(
        {.plan = plan, .free_flight = free_flight}, nullptr, [](int) { return std::nullopt; }, {},
        [&] { return corridor; });
    EXPECT_FALSE(controls.lines().corridor.now) << "before the first step";
    for (int i = 1; i <= 500; ++i) {
        controls.operator_input().put({.orbit_azimuth_rad = turn_deg / 500 * M_PI / 180}, {});
        controls.step(0.02 * i, std::nullopt);
    }
    return controls.lines();
}

TEST(FlightControlsInACorridor, StopAtTheEndAndReportTheEdge) {
    const CorridorStats stats = lines_after_a_turn(false, 180).corridor;
    ASSERT_TRUE(stats.now);
    EXPECT_GE(stats.now->share, Corridor::end);
    EXPECT_EQ(Corridor::place_of(stats.now->share), CorridorPlace::edge);
    EXPECT_GT(stats.edge_s, 1);
    EXPECT_EQ(stats.beyond_s, 0);
}

TEST(FlightControlsInACorridor, FreeFlightLeavesItAndReportsThat) {
    const CorridorStats stats = lines_after_a_turn(true, 120).corridor;
    ASSERT_TRUE(stats.now);
    EXPECT_EQ(Corridor::place_of(stats.now->share), CorridorPlace::beyond);
    EXPECT_EQ(stats.now->loss, CoverageLoss::aside);
    EXPECT_GT(stats.beyond_s, 1);
    EXPECT_EQ(stats.least_share, stats.now->share);
}

TEST_F(FlightControlsTest, SeekIsInTheNextStepOnly) {
    controls_.seek(120);
    controls_.seek(125.5);
    EXPECT_EQ(controls_.step(0.1, std::nullopt).time.to_pulse, 125.5) << "the last one counts";
    EXPECT_FALSE(controls_.step(0.2, std::nullopt).time.to_pulse);
}

TEST_F(FlightControlsTest, ReportsTheEditedMove) {
    controls_.step(0.1, std::nullopt);
    EXPECT_EQ(controls_.move(), nullptr);
    for (const double time_s : {0.2, 0.3}) {
        controls_.operator_input().put({.commands = {command::AddKeyframe{}}}, MonotonicTime{1h});
        controls_.step(time_s, std::nullopt);
    }
    ASSERT_NE(controls_.move(), nullptr);
    EXPECT_EQ(controls_.move()->keyframes().size(), 2u);
}

TEST_F(FlightControlsTest, ReportsStoredShots) {
    controls_.step(0.1, std::nullopt);
    EXPECT_FALSE(controls_.shots()[2]);
    controls_.operator_input().put({.commands = {command::StoreShot{3}}}, MonotonicTime{1h});
    const OrbitView view = controls_.step(0.2, std::nullopt).view;
    ASSERT_TRUE(controls_.shots()[2]);
    EXPECT_TRUE(is_same_view(controls_.shots()[2]->view.camera(), view.camera()));
    EXPECT_FALSE(controls_.shots()[0]);
}

TEST_F(FlightControlsTest, PassesSessionCommandsOnInOrder) {
    controls_.operator_input().put(
        {.commands = {command::ToggleTake{}, command::SaveBackground{}, command::ToggleOutput{2}}},
        MonotonicTime{1h});
    EXPECT_TRUE(controls_.take_requests().commands.empty()) << "no step has taken them yet";
    step();
    controls_.operator_input().put(
        {.commands = {command::LearnBackground{}, command::ToggleOutput{1}}}, MonotonicTime{1h});
    step();
    const SessionRequests requests = controls_.take_requests();
    ASSERT_EQ(requests.commands.size(), 5u);
    EXPECT_TRUE(std::holds_alternative<command::ToggleTake>(requests.commands[0]));
    EXPECT_TRUE(std::holds_alternative<command::SaveBackground>(requests.commands[1]));
    EXPECT_EQ(std::get<command::ToggleOutput>(requests.commands[2]).number, 2);
    EXPECT_TRUE(std::holds_alternative<command::LearnBackground>(requests.commands[3]));
    EXPECT_EQ(std::get<command::ToggleOutput>(requests.commands[4]).number, 1);
    EXPECT_TRUE(controls_.take_requests().commands.empty()) << "every request is given once";
}

TEST_F(FlightControlsTest, TrackedCameraFliesWithoutAJumpUntilInputSteers) {
    CameraState tracked = step().view.camera();
    tracked.world_from_camera.translation() += Eigen::Vector3d(1, 0, 0);
    const auto distance = [&](const CameraStep& step) {
        return (step.camera.value_or(step.view.camera()).world_from_camera.translation() -
                tracked.world_from_camera.translation())
            .norm();
    };
    CameraStep now = step();
    for (double last = distance(now); last > 1e-9; last = distance(now)) {
        controls_.tracked().put(tracked, MonotonicClock::now());
        now = step();
        ASSERT_LE(last - distance(now), 0.06) << "no jump";
        ASSERT_LE(distance(now), last);
        EXPECT_TRUE(controls_.lines().is_tracked);
    }
    turn(5);
    controls_.tracked().put(tracked, MonotonicClock::now());
    now = step();
    EXPECT_FALSE(controls_.lines().is_tracked) << "the operator has taken over";
    EXPECT_LT(distance(now), 0.1) << "from where it was";
    controls_.operator_input().put({.commands = {command::ToggleTracking{}}}, MonotonicTime{1h});
    controls_.tracked().put(tracked, MonotonicClock::now());
    step();
    EXPECT_TRUE(controls_.lines().is_tracked);
}

TEST_F(FlightControlsTest, OperatorFliesThePreviewAndACutBringsItOnAir) {
    const Pose before = step().view.world_from_camera();
    controls_.operator_input().put({.commands = {command::TogglePreview{}}}, {});
    EXPECT_TRUE(step().preview->world_from_camera().isApprox(before, 1e-9));
    controls_.operator_input().put({.orbit_azimuth_rad = 0.4}, {});
    CameraStep now = step();
    for (int i = 0; i < 200; ++i) {
        now = step();
        ASSERT_TRUE(now.view.world_from_camera().isApprox(before, 1e-12)) << "not moved on air";
    }
    ASSERT_TRUE(now.preview);
    ASSERT_TRUE(controls_.lines().preview);
    const Pose previewed = now.preview->world_from_camera();
    EXPECT_GT((previewed.translation() - before.translation()).norm(), 0.5);
    controls_.operator_input().put({.commands = {command::Cut{}}}, {});
    now = step();
    EXPECT_TRUE(now.view.world_from_camera().isApprox(previewed, 1e-6));
    EXPECT_TRUE(now.preview->world_from_camera().isApprox(before, 1e-6));
    controls_.operator_input().put(
        {.commands = {command::SetFlyDuration{0.1 * 20}, command::FlyToPreview{}}}, {});
    step();
    EXPECT_EQ(controls_.lines().fly_to_preview_s, 2);
    EXPECT_TRUE(controls_.lines().preview->fly_progress);
    for (int i = 0; i < 200; ++i) now = step();
    EXPECT_TRUE(now.view.world_from_camera().isApprox(before, 1e-6));
    controls_.operator_input().put({.commands = {command::TogglePreview{}}}, {});
    EXPECT_FALSE(step().preview);
    EXPECT_FALSE(controls_.lines().preview);
}

TEST_F(FlightControlsTest, CutWithoutAPreviewDoesNothing) {
    const OrbitView before = step().view;
    controls_.operator_input().put({.commands = {command::Cut{}}}, {});
    controls_.operator_input().put({.commands = {command::FlyToPreview{}}}, {});
    step();
    EXPECT_TRUE(is_same_view(step().view.camera(), before.camera()));
}

TEST_F(FlightControlsTest, CutFromATrackedCameraDoesNotGlide) {
    CameraState tracked = step().view.camera();
    tracked.world_from_camera.translation() += Eigen::Vector3d(1, 0, 0);
    controls_.operator_input().put({.commands = {command::TogglePreview{}}}, {});
    const Pose previewed = step().preview->world_from_camera();
    const auto track = [&] {
        controls_.tracked().put(tracked, MonotonicClock::now());
        return step();
    };
    for (int i = 0; i < 100; ++i) track();
    controls_.operator_input().put({.orbit_elevation_rad = 0.0001}, {});
    EXPECT_TRUE(track().camera)
        << "the tracked camera stays on air while the operator flies the preview";
    controls_.operator_input().put({.commands = {command::Cut{}}}, {});
    const CameraStep now = track();
    EXPECT_FALSE(now.camera);
    EXPECT_TRUE(now.view.world_from_camera().isApprox(previewed, 1e-3));
}

TEST_F(FlightControlsTest, PerformerIsFollowedByTheCameraThatWasTold) {
    controls_.operator_input().put({.commands = {command::ToggleFollow{}}}, {});
    step();
    controls_.operator_input().put({.commands = {command::TogglePreview{}}}, {});
    step();
    ASSERT_EQ(controls_.lines().following.size(), 1u);
    EXPECT_FALSE(controls_.lines().is_following) << "the operator's camera does not";
    const auto [camera, pivot_m] = controls_.lines().following[0];
    const Eigen::Vector3d there_m = pivot_m + Eigen::Vector3d(0.2, 0, 0);
    controls_.operator_input().put({.commands = {command::Cut{}}}, {});
    step();
    controls_.follow({camera, there_m});
    CameraStep now = step();
    for (int i = 0; i < 200; ++i) now = step();
    EXPECT_TRUE(now.preview->pivot_m.isApprox(there_m, 1e-3));
    EXPECT_TRUE(now.view.pivot_m.isApprox(pivot_m, 1e-6));
}

}  // namespace
}  // namespace vantage
