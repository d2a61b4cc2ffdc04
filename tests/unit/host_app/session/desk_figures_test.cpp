#include "host_app/desk/feed/desk_values.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

std::string value_of(const std::vector<DeskFigure>& figures, const std::string& name) {
    for (const DeskFigure& figure : figures)
        if (figure.name == name) return figure.value;
    return "none";
}

TEST(DeskFigures, SayWhatTheSummarySays) {
    LiveReport report;
    report.programme.ticks = 450;
    report.programme.reprojected = 31;
    report.programme.repeated = 7;
    report.programme.missed = 2;
    report.programme.interval_ms = {400, 67, 67.2, 68.6, 134};
    report.programme.render_shares = {0, 0, 0, 0, 0.96, 0.04};
    report.programme.prepare_shares = {0, 1};
    report.instants_prepared = 141;
    report.frame_sets_superseded = 3;
    const std::vector<DeskFigure> figures = desk_figures(report);
    EXPECT_EQ(value_of(figures, "ticks, reprojected, repeated, missed"), "450, 31, 7, 2");
    EXPECT_EQ(value_of(figures, "between pictures"), "67 ms, 99 % 69, at worst 134");
    EXPECT_EQ(value_of(figures, "hand to picture"), "none") << "no hand was there";
    EXPECT_EQ(value_of(figures, "instants, skipped"), "141, 3");
    EXPECT_EQ(value_of(figures, "rendering, by level"), "4: 96 %, 5: 4 %");
    EXPECT_EQ(value_of(figures, "preparing, by level"), "1: 100 %");
}

TEST(DeskFigures, AreNoneBeforeTheFirstPicture) { EXPECT_TRUE(desk_figures({}).empty()); }

}  // namespace
}  // namespace vantage
