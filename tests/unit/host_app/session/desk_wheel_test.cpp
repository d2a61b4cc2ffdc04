#include "host_app/desk/feed/desk_values.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

WheelMapView ring_at(double at) {
    WheelMapView view;
    view.name = "wheel";
    view.controls = {{{JogKind::axis, "ring"}, "shuttle", at != 0, at}};
    view.feel.action = AxisAction::shuttle;
    view.feel.dead_zone = 0.2;
    view.feel.curve = 2;
    return view;
}

TEST(DeskWheel, HasNothingToShowOfAClosedMap) { EXPECT_FALSE(desk_wheel(std::nullopt)); }

TEST(DeskWheel, GraphsWhatARingAsksForAlongItsWay) {
    const DeskWheel::Feel feel = desk_wheel(ring_at(0.6))->feel.value();
    EXPECT_EQ(feel.most, 2) << "twice the speed at its end";
    EXPECT_EQ(feel.response.front(), -2);
    EXPECT_EQ(feel.response.back(), 2);
    EXPECT_EQ(feel.response[feel.response.size() / 2], 0);
    EXPECT_EQ(feel.at, 0.6);
    // Half of its way beyond the dead zone, squared: between the notches of 0.1 and 0.25.
    EXPECT_NEAR(feel.asks, 0.1 + 0.75 * 0.15, 1e-9);
}

TEST(DeskWheel, GraphsWhatATurnAsksFor) {
    WheelMapView view;
    view.controls = {{{JogKind::step, "jog"}, "wheel", false, 12}};
    view.feel.sensitivity = 0.5;
    view.feel.inverted = true;
    view.turned = 3;
    const DeskWheel::Feel feel = desk_wheel(view)->feel.value();
    EXPECT_EQ(feel.at, 3);
    EXPECT_EQ(feel.asks, -1.5);
    EXPECT_EQ(feel.response.back(), -0.5f * static_cast<float>(feel.to));
}

TEST(DeskWheel, HasNoFeelOfAButton) {
    WheelMapView view;
    view.controls = {{{JogKind::button, "b1"}, "shot 1", true, 1}};
    const DeskWheel wheel = *desk_wheel(view);
    EXPECT_FALSE(wheel.feel);
    EXPECT_TRUE(wheel.controls[0].is_held);
}

}  // namespace
}  // namespace vantage
