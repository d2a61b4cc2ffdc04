#include "host_app/control/flight_controls.h"

#include <thread>

#include <gtest/gtest.h>

#include "common/gl/egl_context.h"
#include "tests/unit/hid/scripted_port.h"
#include "tests/unit/sets/scripted_feed.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

/// A wheel in a pretended socket, and the pictures that come of turning it.
class FlightControlsTest : public testing::Test {
  protected:
    FlightControlsTest() {
        feed_.push(feed_.set(1, {"north", "south"}));
        session_.wait_for_rigs(10s, stop_);
        plug_in();
        make_picture();
    }

    static FlightPlan start() {
        FlightPlan plan;
        plan.start.distance_m = 4.5;
        plan.start.field_of_view_rad = 1.0;
        return plan;
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
    void push_button(std::uint8_t bits) {
        send({0, detent_, 0, static_cast<std::uint8_t>(bits << 4), 0});
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

    /// The next picture, so long after the one before.
    ColourImage make_picture(std::chrono::nanoseconds after = 20ms) {
        time_ += after;
        const OrbitView view =
            controls_.step({}, session_, std::chrono::duration<double>(time_).count());
        session_.make_picture(view, time_);
        EXPECT_EQ(session_.last_view().azimuth_rad, view.azimuth_rad);
        return session_.last_picture();
    }
    double azimuth_rad() const { return session_.last_view().azimuth_rad; }

    EglContext context_;
    ShaderLibrary shaders_;
    StopSignal stop_;
    ScriptedFeed feed_{{"north", "south"}};
    LiveSession session_{
        {.width_px = 64, .height_px = 48, .rate_hz = 50, .film = {}, .contact_sheet = {}},
        shaders_,
        feed_.feed()};
    ScriptedSockets sockets_;
    JogDeck deck_{sockets_.bus(), load_wheel_profiles(), {.raw_reports = false, .look_every = 5ms}};
    FlightControls controls_{start(), session_, &deck_};
    std::shared_ptr<ScriptedDevice> wheel_;
    std::uint8_t detent_ = 7;
    std::uint64_t reports_ = 0;
    std::chrono::nanoseconds time_{0};
};

TEST_F(FlightControlsTest, ATurnOfTheWheelIsInTheNextPicture) {
    const ColourImage before = make_picture();
    const double azimuth_before_rad = azimuth_rad();
    turn(3);
    const ColourImage after = make_picture();
    EXPECT_GT(std::abs(azimuth_rad() - azimuth_before_rad), 1e-3);
    EXPECT_GT(cv::norm(before, after, cv::NORM_INF), 10) << "the camera moved and its picture not";
}

TEST_F(FlightControlsTest, TheShuttleMovesTheNextPictureAndAllAfterIt) {
    send({3, detent_, 0, 0, 0});
    double last_rad = azimuth_rad();
    for (int i = 0; i < 5; ++i) {
        make_picture();
        EXPECT_GT(std::abs(azimuth_rad() - last_rad), 1e-6) << "picture " << i;
        last_rad = azimuth_rad();
    }
}

TEST_F(FlightControlsTest, ThePictureAfterTheFreezeButtonIsFrozen) {
    push_button(0b100);
    make_picture();
    EXPECT_TRUE(session_.frozen());
}

TEST_F(FlightControlsTest, HoldsItsPoseWithoutTheWheelAndGoesOnWhenItIsBack) {
    turn(3);
    send({7, detent_, 0, 0, 0});
    make_picture();
    unplug();
    make_picture(5s);
    const double held_rad = azimuth_rad();
    make_picture(5s);
    EXPECT_NEAR(azimuth_rad(), held_rad, 1e-9)
        << "the ring was pushed to its stop when the cable went";
    plug_in();
    make_picture();
    EXPECT_NEAR(azimuth_rad(), held_rad, 1e-9) << "a wheel that comes back asks for nothing yet";
    turn(-2);
    make_picture();
    EXPECT_GT(std::abs(azimuth_rad() - held_rad), 1e-3);
}

}  // namespace
}  // namespace vantage
