#include "host_app/control/flight_controls.h"

#include <thread>
#include <tuple>

#include <gtest/gtest.h>

#include "tests/unit/host_app/flight/ring_of_rigs.h"
#include "tests/unit/host_app/hid/scripted_port.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

TEST(OperatorInputBox, AddsUpWhatComesAndKnowsTheEarliest) {
    OperatorInputBox box;
    EXPECT_FALSE(box.take().since);
    const MonotonicTime start{1h};
    box.put({}, start);
    EXPECT_FALSE(box.take().since) << "no hand moved";
    box.put({.orbit_azimuth_rad = 0.1}, start + 1ms);
    box.put({.orbit_azimuth_rad = 0.2, .toggle_freeze = true}, start + 5ms);
    const OperatorInputBox::Taken taken = box.take();
    EXPECT_NEAR(taken.input.orbit_azimuth_rad, 0.3, 1e-12);
    EXPECT_TRUE(taken.input.toggle_freeze);
    EXPECT_EQ(taken.since, start + 1ms);
    EXPECT_FALSE(box.take().input.is_any()) << "every input is taken once";
}

TEST(OperatorInputBox, KeepsACommandThatIsGivenAgainForTheNextStep) {
    OperatorInputBox box;
    const MonotonicTime start{1h};
    EXPECT_TRUE(box.put({.toggle_output = 1}, start));
    EXPECT_TRUE(box.put({.orbit_azimuth_rad = 0.1, .toggle_output = 2}, start + 1ms));
    EXPECT_TRUE(box.put({.orbit_azimuth_rad = 0.2, .mark_in = true}, start + 2ms));
    EXPECT_EQ(box.take().input.toggle_output, 1);
    const OperatorInputBox::Taken second = box.take();
    EXPECT_EQ(second.input.toggle_output, 2);
    EXPECT_TRUE(second.input.mark_in);
    EXPECT_NEAR(second.input.orbit_azimuth_rad, 0.3, 1e-12);
    EXPECT_EQ(second.since, start + 1ms);
}

TEST(OperatorInputBox, LeavesOutCommandsBeyondItsBoundAndNoTurns) {
    OperatorInputBox box;
    std::size_t left_out = 0;
    for (int i = 0; i < 1000; ++i)
        left_out += box.put({.orbit_azimuth_rad = 0.001, .toggle_freeze = true}, {}) ? 0 : 1;
    EXPECT_EQ(left_out, 1000 - OperatorInputBox::most_waiting);
    double turned_rad = 0;
    for (std::size_t i = 0; i < OperatorInputBox::most_waiting; ++i) {
        const FlightInput input = box.take().input;
        EXPECT_TRUE(input.toggle_freeze);
        turned_rad += input.orbit_azimuth_rad;
    }
    EXPECT_NEAR(turned_rad, 1.0, 1e-9);
    EXPECT_FALSE(box.take().since);
}

TEST(OperatorInputBox, KeepsTheOrderOfWhatIsAskedOfTime) {
    OperatorInputBox box;
    box.put({.mark_in = true}, {});
    box.put({.replay = {{ReplayAction::make_clip}}}, {});
    box.put({.mark_out = true}, {});
    box.put({.orbit_azimuth_rad = 0.1}, {});
    const FlightInput first = box.take().input, second = box.take().input;
    EXPECT_TRUE(first.mark_in && !first.mark_out);
    EXPECT_EQ(first.replay.size(), 1u);
    EXPECT_TRUE(second.mark_out);
    EXPECT_EQ(second.orbit_azimuth_rad, 0.1);
}

TEST(FlightControlsInThePast, TheWayBackToLiveMovesNoCamera) {
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
        return std::pair(way, step.time.to_live);
    };
    fly({.past_steps = -10}, {});
    fly({.replay = {{ReplayAction::play_clip}}}, 90);
    // The clip is flown with shot 3; the way there is not over when live is asked for.
    (void)controls.fly_to_shot(3);
    for (int i = 0; i < 10; ++i) fly({.orbit_azimuth_rad = 0}, 91 + i);
    EXPECT_GT(fastest, 0) << "it flies";
    const double before = fastest;
    bool is_live_asked = false;
    std::tie(at_live, is_live_asked) = fly({.to_live = true}, 102);
    EXPECT_TRUE(is_live_asked);
    EXPECT_LE(at_live, 1.2 * before) << "it goes on as it flew";
    for (int i = 0; i < 100; ++i) fly({}, {});
    EXPECT_LT(fly({.to_live = true}, {}).first, 1e-12) << "and what stands stays";
}

TEST(FlightControlsInThePast, AShotThatTakesNoTimeIsThereInTheSameStep) {
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

TEST(FlightControlsInATake, AFlightSaysWhatTimeItIs) {
    FlightControls controls(
        {.plan = frozen_flight(), .pulse_rate_hz = 25, .has_past = true, .take_begin = 1000},
        nullptr, [](int) { return std::nullopt; });
    EXPECT_EQ(controls.step(0, 1000).time.at_pulse, 1050);
    EXPECT_EQ(controls.step(0.5, 1050).time.at_pulse, 1050) << "frozen";
    EXPECT_NEAR(*controls.step(1.5, 1050).time.at_pulse, 1075, 1e-9);
    // Who holds time holds the flight; who turns it takes it over.
    controls.operator_input().put({.toggle_freeze = true}, {});
    const CameraStep held = controls.step(1.6, 1075);
    EXPECT_FALSE(held.time.toggle_hold);
    EXPECT_NEAR(*held.time.at_pulse, 1075, 1e-9);
    EXPECT_NEAR(*controls.step(1.9, 1075).time.at_pulse, 1075, 1e-9);
    controls.operator_input().put({.past_steps = 1}, {});
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

TEST(FlightControlsInATake, ALiveStageIsNotLed) {
    FlightControls controls({.plan = frozen_flight(), .pulse_rate_hz = 25, .has_past = true},
                            nullptr, [](int) { return std::nullopt; });
    EXPECT_FALSE(controls.step(0.5, {}).time.at_pulse);
}

TEST(FlightControlsRecording, KeepsEveryStepWithItsTimeInTheTake) {
    FlightControls controls({.plan = {}, .pulse_rate_hz = 25, .has_past = true, .take_begin = 1000},
                            nullptr, [](int) { return std::nullopt; });
    controls.operator_input().put({.toggle_recording = true}, {});
    for (int i = 0; i < 10; ++i) {
        controls.operator_input().put({.orbit_azimuth_rad = 0.1}, {});
        controls.step(5 + 0.02 * i, 1000 + i);
        EXPECT_TRUE(controls.lines().is_recording);
    }
    EXPECT_TRUE(controls.take_requests().flight.empty()) << "it goes on";
    controls.operator_input().put({.toggle_recording = true}, {});
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

TEST(FlightControlsPivot, GoesToTheSessionAndComesBackAsAPlaceOnTheStage) {
    FlightControls controls({.plan = {}, .pulse_rate_hz = 25}, nullptr,
                            [](int) { return std::nullopt; });
    controls.operator_input().put({.pick = Eigen::Vector2d(0.25, 0.75)}, {});
    controls.step(0, {});
    EXPECT_EQ(controls.take_requests().pick, Eigen::Vector2d(0.25, 0.75));
    EXPECT_FALSE(controls.take_requests().pick) << "once";
    controls.operator_input().put({.pivot_m = Eigen::Vector3d(1, 1.2, -1)}, {});
    for (int i = 1; i < 200; ++i) controls.step(0.02 * i, {});
    EXPECT_TRUE(controls.step(4.1, {}).view.pivot_m.isApprox(Eigen::Vector3d(1, 1.2, -1), 1e-6));
}

TEST(FlightControlsPivot, FollowsUntilAHandTakesItElsewhere) {
    FlightControls controls({.plan = {}, .pulse_rate_hz = 25}, nullptr,
                            [](int) { return std::nullopt; });
    double time_s = 0;
    const auto pass = [&] {
        for (int i = 0; i < 200; ++i) controls.step(time_s += 0.02, {});
        return controls.step(time_s += 0.02, {}).view.pivot_m;
    };
    controls.follow({1, {1, 1, 0}});
    EXPECT_NEAR(pass().x(), 0, 1e-9) << "nobody asked for it";
    controls.operator_input().put({.toggle_follow = true}, {});
    pass();
    EXPECT_TRUE(controls.lines().is_following);
    ASSERT_EQ(controls.lines().following.size(), 1u);
    controls.follow({controls.lines().following[0].camera, {1, 1, 0}});
    EXPECT_NEAR(pass().x(), 1, 1e-6);
    controls.operator_input().put({.orbit_azimuth_rad = 0.3}, {});
    pass();
    EXPECT_TRUE(controls.lines().is_following) << "one may orbit meanwhile";
    controls.operator_input().put({.pan_right_widths = 0.1}, {});
    const double panned = pass().x();
    EXPECT_FALSE(controls.lines().is_following);
    controls.follow({1, {-1, 1, 0}});
    EXPECT_NEAR(pass().x(), panned, 1e-9);
}

TEST(FlightControlsRecording, EndsWithTheShow) {
    FlightControls controls({.plan = {}, .pulse_rate_hz = 25}, nullptr,
                            [](int) { return std::nullopt; });
    controls.operator_input().put({.toggle_recording = true}, {});
    controls.step(0.1, {});
    controls.end_recording();
    EXPECT_EQ(controls.take_requests().flight.size(), 1u);
}

/// A wheel in a pretended socket, and the steps that come of turning it.
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
    /// Until the computer has read it: the same report again tells nothing new, and is counted only
    /// once the one before it is through.
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

    /// The next one, so long after the one before.
    CameraStep step(double after_s = 0.02) {
        time_s_ += after_s;
        const CameraStep step = controls_.step(time_s_, std::nullopt);
        azimuth_rad_ = step.view.azimuth_rad;
        return step;
    }

    ScriptedSockets sockets_;
    JogDevices deck_{sockets_.bus(), load_wheel_profiles(), {.raw_reports = false, .look_every = 5ms}};
    FlightControls controls_{
        {.plan = start(), .pulse_rate_hz = 25, .has_past = true}, &deck_, rig_view};
    std::shared_ptr<ScriptedDevice> wheel_;
    std::uint8_t detent_ = 7;
    std::uint64_t reports_ = 0;
    double time_s_ = 0, azimuth_rad_ = 0;
};

TEST_F(FlightControlsTest, HoldsItsPoseWhileNoHandMoves) {
    const double before_rad = azimuth_rad_;
    for (int i = 0; i < 20; ++i) {
        const CameraStep still = step();
        EXPECT_FALSE(still.hand);
        EXPECT_FALSE(still.time.toggle_hold || still.time.to_live || still.next_synthesiser ||
                     still.toggle_source_map);
        EXPECT_EQ(still.time.pulses, 0);
    }
    EXPECT_EQ(azimuth_rad_, before_rad);
}

TEST_F(FlightControlsTest, ATurnOfTheWheelIsInTheNextStep) {
    const double before_rad = azimuth_rad_;
    const MonotonicTime before = MonotonicClock::now();
    turn(3);
    const CameraStep turned = step();
    EXPECT_GT(std::abs(azimuth_rad_ - before_rad), 1e-3);
    ASSERT_TRUE(turned.hand);
    EXPECT_GE(*turned.hand, before);
    EXPECT_LE(*turned.hand, MonotonicClock::now());
    EXPECT_FALSE(step().hand) << "once only";
}

TEST_F(FlightControlsTest, TheShuttleMovesTheNextStepAndAllAfterIt) {
    send({3, detent_, 0, 0, 0});
    double last_rad = azimuth_rad_;
    for (int i = 0; i < 5; ++i) {
        step();
        EXPECT_GT(std::abs(azimuth_rad_ - last_rad), 1e-6) << "step " << i;
        last_rad = azimuth_rad_;
    }
}

TEST_F(FlightControlsTest, TheStepAfterTheFreezeButtonHolds) {
    push_button(3);
    EXPECT_TRUE(step().time.toggle_hold);
    EXPECT_FALSE(step().time.toggle_hold);
}

TEST_F(FlightControlsTest, HoldsItsPoseWithoutTheWheelAndGoesOnWhenItIsBack) {
    turn(3);
    send({7, detent_, 0, 0, 0});
    step();
    unplug();
    step(5);
    const double held_rad = azimuth_rad_;
    step(5);
    EXPECT_NEAR(azimuth_rad_, held_rad, 1e-9)
        << "the ring was pushed to its stop when the cable went";
    plug_in();
    step();
    EXPECT_NEAR(azimuth_rad_, held_rad, 1e-9) << "a wheel that comes back asks for nothing yet";
    turn(-2);
    step();
    EXPECT_GT(std::abs(azimuth_rad_ - held_rad), 1e-3);
}

TEST_F(FlightControlsTest, TheWheelGoesThroughThePastPulseByPulse) {
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
    EXPECT_GT(pulses, 1) << "forward, by the ring";
    EXPECT_LE(pulses, 2 * 25 + 1e-9) << "at most at twice the stage's rate";
    EXPECT_EQ(azimuth_rad_, before_rad) << "the camera stays";
}

TEST_F(FlightControlsTest, MouseAndWheelMeetInOneStep) {
    turn(1);
    const MonotonicTime earlier = MonotonicClock::now() - 1s;
    controls_.operator_input().put({.toggle_freeze = true,
                           .next_synthesiser = true,
                           .to_live = true,
                           .toggle_source_map = true,
                           .past_steps = -2},
                          earlier);
    const double before_rad = azimuth_rad_;
    const CameraStep both = step();
    EXPECT_TRUE(both.time.toggle_hold && both.next_synthesiser && both.time.to_live &&
                both.toggle_source_map);
    EXPECT_EQ(both.time.pulses, -2);
    EXPECT_GT(std::abs(azimuth_rad_ - before_rad), 1e-4);
    EXPECT_EQ(both.hand, earlier) << "the earlier of the two hands";
}

TEST_F(FlightControlsTest, AWheelWhoseMapIsOpenMovesNothingAndDoesThenWhatItSays) {
    send({5, detent_, 0, 0, 0});
    step();
    controls_.wheels().serve_desk();
    controls_.operator_input().put({.toggle_jog_map = true}, {});
    step();
    for (int i = 0; i < 100; ++i) step();  // what was under way comes to rest
    const double before_rad = azimuth_rad_;
    turn(5);
    push_button(3);
    push_button(1);
    for (int i = 0; i < 20; ++i) {
        const CameraStep still = step();
        EXPECT_FALSE(still.time.toggle_hold || still.hand);
    }
    EXPECT_NEAR(azimuth_rad_, before_rad, 1e-6) << "not even by the ring that is held";
    EXPECT_NE(controls_.lines().wheel.find("moves nothing"), std::string::npos);
    controls_.wheels().obey({WheelCall::What::assign, 0, "mark_in"});
    controls_.wheels().obey({WheelCall::What::close});
    EXPECT_NE((step(), controls_.lines().wheel).find("not saved"), std::string::npos);
    push_button(1);
    EXPECT_TRUE(step().time.mark_in) << "and it flies to no shot";
}

TEST_F(FlightControlsTest, FliesToWhatARigSees) {
    push_button(1);
    for (int i = 0; i < 500; ++i) step();
    EXPECT_NEAR(azimuth_rad_, 0.3, 0.01);
    push_button(2);
    for (int i = 0; i < 100; ++i) step();
    EXPECT_NEAR(azimuth_rad_, 0.3, 0.01) << "there is no second rig";
}

TEST_F(FlightControlsTest, TellsWhatTheWheelDrives) {
    step();
    EXPECT_NE(controls_.lines().wheel.find("drives the orbit"), std::string::npos)
        << controls_.lines().wheel;
    EXPECT_FALSE(controls_.lines().move_progress);
    unplug();
    step();
    EXPECT_EQ(controls_.lines().wheel, "");
}

TEST(FlightControlsWithoutADeck, FlyThePlannedMove) {
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

/// Hands that turn the camera on and on, with what two rigs at 10 degrees cover.
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

TEST(FlightControlsInACorridor, StandAtItsEndAndSayThatTheyAreAtItsEdge) {
    const CorridorStats stats = lines_after_a_turn(false, 180).corridor;
    ASSERT_TRUE(stats.now);
    EXPECT_GE(stats.now->share, Corridor::end);
    EXPECT_EQ(Corridor::place_of(stats.now->share), CorridorPlace::edge);
    EXPECT_GT(stats.edge_s, 1);
    EXPECT_EQ(stats.beyond_s, 0);
}

TEST(FlightControlsInACorridor, FreeFlightGoesBeyondAndSaysSo) {
    const CorridorStats stats = lines_after_a_turn(true, 120).corridor;
    ASSERT_TRUE(stats.now);
    EXPECT_EQ(Corridor::place_of(stats.now->share), CorridorPlace::beyond);
    EXPECT_EQ(stats.now->loss, CoverageLoss::aside);
    EXPECT_GT(stats.beyond_s, 1);
    EXPECT_EQ(stats.least_share, stats.now->share);
}

TEST_F(FlightControlsTest, ASeekIsInTheNextStepAndInNoOther) {
    controls_.seek(120);
    controls_.seek(125.5);
    EXPECT_EQ(controls_.step(0.1, std::nullopt).time.to_pulse, 125.5) << "the last one counts";
    EXPECT_FALSE(controls_.step(0.2, std::nullopt).time.to_pulse);
}

TEST_F(FlightControlsTest, TellsTheMoveAsHandsHaveLeftIt) {
    controls_.step(0.1, std::nullopt);
    EXPECT_EQ(controls_.move(), nullptr);
    for (const double time_s : {0.2, 0.3}) {
        controls_.operator_input().put({.add_keyframe = true}, MonotonicTime{1h});
        controls_.step(time_s, std::nullopt);
    }
    ASSERT_NE(controls_.move(), nullptr);
    EXPECT_EQ(controls_.move()->keyframes().size(), 2u);
}

TEST_F(FlightControlsTest, TellsWhichShotsAreKept) {
    controls_.step(0.1, std::nullopt);
    EXPECT_FALSE(controls_.shots()[2]);
    controls_.operator_input().put({.store_shot = 3}, MonotonicTime{1h});
    const OrbitView view = controls_.step(0.2, std::nullopt).view;
    ASSERT_TRUE(controls_.shots()[2]);
    EXPECT_TRUE(is_same_view(controls_.shots()[2]->view.camera(), view.camera()));
    EXPECT_FALSE(controls_.shots()[0]);
}

TEST_F(FlightControlsTest, GivesTheSessionWhatIsNotTheProgrammesToDo) {
    controls_.operator_input().put({.toggle_take = true, .save_background = true, .toggle_output = 2},
                          MonotonicTime{1h});
    EXPECT_FALSE(controls_.take_requests().toggle_take) << "no step has taken it yet";
    step();
    controls_.operator_input().put({.learn_background = true, .toggle_output = 1}, MonotonicTime{1h});
    step();
    const SessionRequests requests = controls_.take_requests();
    EXPECT_TRUE(requests.toggle_take);
    EXPECT_TRUE(requests.save_background);
    EXPECT_TRUE(requests.learn_background);
    EXPECT_EQ(requests.outputs, (std::vector<int>{2, 1}));
    EXPECT_TRUE(controls_.take_requests().outputs.empty()) << "every wish is given once";
}

TEST_F(FlightControlsTest, ATrackedCameraFliesWithoutAJumpUntilAHandSteers) {
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
    EXPECT_FALSE(controls_.lines().is_tracked) << "a hand has taken over";
    EXPECT_LT(distance(now), 0.1) << "from where it was";
    controls_.operator_input().put({.toggle_tracking = true}, MonotonicTime{1h});
    controls_.tracked().put(tracked, MonotonicClock::now());
    step();
    EXPECT_TRUE(controls_.lines().is_tracked);
}

TEST_F(FlightControlsTest, HandsFlyThePreviewAndACutBringsItToAir) {
    const Pose before = step().view.world_from_camera();
    controls_.operator_input().put({.toggle_preview = true}, {});
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
    controls_.operator_input().put({.cut = true}, {});
    now = step();
    EXPECT_TRUE(now.view.world_from_camera().isApprox(previewed, 1e-6));
    EXPECT_TRUE(now.preview->world_from_camera().isApprox(before, 1e-6));
    controls_.operator_input().put({.fly_to_preview = true, .fly_to_preview_tenths = 20}, {});
    step();
    EXPECT_EQ(controls_.lines().fly_to_preview_s, 2);
    EXPECT_TRUE(controls_.lines().preview->fly_progress);
    for (int i = 0; i < 200; ++i) now = step();
    EXPECT_TRUE(now.view.world_from_camera().isApprox(before, 1e-6));
    controls_.operator_input().put({.toggle_preview = true}, {});
    EXPECT_FALSE(step().preview);
    EXPECT_FALSE(controls_.lines().preview);
}

TEST_F(FlightControlsTest, WithoutAPreviewNothingIsCutTo) {
    const OrbitView before = step().view;
    controls_.operator_input().put({.cut = true}, {});
    controls_.operator_input().put({.fly_to_preview = true}, {});
    step();
    EXPECT_TRUE(is_same_view(step().view.camera(), before.camera()));
}

TEST_F(FlightControlsTest, ACutFromATrackedCameraDoesNotGlide) {
    CameraState tracked = step().view.camera();
    tracked.world_from_camera.translation() += Eigen::Vector3d(1, 0, 0);
    controls_.operator_input().put({.toggle_preview = true}, {});
    const Pose previewed = step().preview->world_from_camera();
    const auto track = [&] {
        controls_.tracked().put(tracked, MonotonicClock::now());
        return step();
    };
    for (int i = 0; i < 100; ++i) track();
    controls_.operator_input().put({.orbit_elevation_rad = 0.0001}, {});
    EXPECT_TRUE(track().camera) << "hands on preview leave the tracked camera on air";
    controls_.operator_input().put({.cut = true}, {});
    const CameraStep now = track();
    EXPECT_FALSE(now.camera);
    EXPECT_TRUE(now.view.world_from_camera().isApprox(previewed, 1e-3));
}

TEST_F(FlightControlsTest, APerformerIsFollowedByTheCameraThatWasTold) {
    controls_.operator_input().put({.toggle_follow = true}, {});
    step();
    controls_.operator_input().put({.toggle_preview = true}, {});
    step();
    ASSERT_EQ(controls_.lines().following.size(), 1u);
    EXPECT_FALSE(controls_.lines().is_following) << "the one in hand does not";
    const auto [camera, pivot_m] = controls_.lines().following[0];
    const Eigen::Vector3d there_m = pivot_m + Eigen::Vector3d(0.2, 0, 0);
    controls_.operator_input().put({.cut = true}, {});
    step();
    controls_.follow({camera, there_m});
    CameraStep now = step();
    for (int i = 0; i < 200; ++i) now = step();
    EXPECT_TRUE(now.preview->pivot_m.isApprox(there_m, 1e-3));
    EXPECT_TRUE(now.view.pivot_m.isApprox(pivot_m, 1e-6));
}

}  // namespace
}  // namespace vantage
