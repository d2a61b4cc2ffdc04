#include "host_app/desk/feed/desk_values.h"

#include <gtest/gtest.h>

namespace vantage {

namespace {

std::string value_of(const std::vector<DeskFigure>& figures, const std::string& name) {
    for (const DeskFigure& figure : figures)
        if (figure.name == name) return figure.value;
    return "none";
}

TEST(DeskFigures, MatchTheSummary) {
    LiveReport report;
    report.programme.ticks = 450;
    report.programme.reprojected = 31;
    report.programme.repeated = 7;
    report.programme.missed = 2;
    report.programme.interval_ms = {400, 67, 67.2, 68.6, 134};
    report.programme.render_shares = {0, 0, 0, 0, 0.96, 0.04};
    report.programme.prepare_shares = {0, 1};
    report.instants_prepared = 141;
    report.frame_sets_replaced = 3;
    const std::vector<DeskFigure> figures = desk_figures(report);
    EXPECT_EQ(value_of(figures, "ticks, reprojected, repeated, missed"), "450, 31, 7, 2");
    EXPECT_EQ(value_of(figures, "between frames"), "67 ms, p99 69, max 134");
    EXPECT_EQ(value_of(figures, "input to picture"), "none") << "there was no input";
    EXPECT_EQ(value_of(figures, "instants, skipped"), "141, 3");
    EXPECT_EQ(value_of(figures, "rendering, by level"), "4: 96 %, 5: 4 %");
    EXPECT_EQ(value_of(figures, "preparing, by level"), "1: 100 %");
}

TEST(DeskFigures, AreEmptyBeforeTheFirstPicture) { EXPECT_TRUE(desk_figures({}).empty()); }

}  // namespace

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

TEST(DeskWheel, IsEmptyWhileTheMapIsClosed) { EXPECT_FALSE(desk_wheel(std::nullopt)); }

TEST(DeskWheel, PlotsTheResponseOfARing) {
    const DeskWheel::Feel feel = desk_wheel(ring_at(0.6))->feel.value();
    EXPECT_EQ(feel.most, 2) << "twice the speed at its end";
    EXPECT_EQ(feel.response.front(), -2);
    EXPECT_EQ(feel.response.back(), 2);
    EXPECT_EQ(feel.response[feel.response.size() / 2], 0);
    EXPECT_EQ(feel.at, 0.6);
    // Half of the range beyond the dead zone, squared: between the speeds 0.1 and 0.25.
    EXPECT_NEAR(feel.asks, 0.1 + 0.75 * 0.15, 1e-9);
}

TEST(DeskWheel, PlotsTheResponseOfAWheel) {
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

TEST(DeskWheel, HasNoResponseForAButton) {
    WheelMapView view;
    view.controls = {{{JogKind::button, "b1"}, "shot 1", true, 1}};
    const DeskWheel wheel = *desk_wheel(view);
    EXPECT_FALSE(wheel.feel);
    EXPECT_TRUE(wheel.controls[0].is_held);
}

}  // namespace

}  // namespace vantage
