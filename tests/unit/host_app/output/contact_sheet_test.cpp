#include "host_app/output/contact_sheet.h"

#include <string>

#include <gtest/gtest.h>

namespace vantage {
namespace {

ColourImage plain(int width_px, int height_px, cv::Vec4b colour) {
    return ColourImage(height_px, width_px, colour);
}

/// How many pixels of the sheet have exactly this colour.
int count(const ColourImage& sheet, cv::Vec4b colour) {
    cv::Mat1b mask;
    cv::inRange(sheet, colour, colour, mask);
    return cv::countNonZero(mask);
}

const cv::Vec4b red(200, 0, 0, 255), green(0, 200, 0, 255), blue(0, 0, 200, 255);

TEST(ContactSheet, ShowsEveryStillUndistorted) {
    std::vector<SheetRow> moments;
    moments.push_back({"first", {{plain(320, 180, red), "view"}, {plain(61, 47, green), "rig"}}});
    moments.push_back({"second", {{plain(320, 180, blue), "view"}}});
    const ColourImage sheet = compose_contact_sheet("flight", moments, 160);
    EXPECT_EQ(count(sheet, red), 160 * 90);
    EXPECT_EQ(count(sheet, blue), 160 * 90);
    EXPECT_EQ(count(sheet, green), 117 * 90);  // 61:47 in a cell of 160 x 90
}

TEST(ContactSheet, WritesTitleAndCaptions) {
    const auto letters = [](const std::string& title, const std::string& caption) {
        const SheetRow moment{"", {{plain(320, 180, red), caption}}};
        const ColourImage sheet = compose_contact_sheet(title, {&moment, 1}, 320);
        // Anti-aliased strokes: whatever is brighter than the ground and not the still's red.
        cv::Mat1b mask;
        cv::inRange(sheet, cv::Vec4b(60, 60, 60, 255), cv::Vec4b(255, 255, 255, 255), mask);
        return cv::countNonZero(mask);
    };
    const int none = letters("", "");
    EXPECT_EQ(none, 0);
    EXPECT_GT(letters("flight", ""), 20);
    EXPECT_GT(letters("", "rig north"), 20);
}

TEST(ContactSheet, ShowsUncoveredPixelsToo) {
    const SheetRow moment{"", {{plain(320, 180, cv::Vec4b(200, 0, 0, 0)), ""}}};
    EXPECT_EQ(count(compose_contact_sheet("", {&moment, 1}, 160), red), 160 * 90);
}

TEST(ContactSheet, KeepsLongCaptionsInTheirCell) {
    const std::string caption(200, 'W');
    const SheetRow moment{"", {{plain(320, 180, red), caption}}};
    const ColourImage sheet = compose_contact_sheet("", {&moment, 1}, 320);
    const ColourImage right_margin = sheet.colRange(sheet.cols - 12, sheet.cols);
    EXPECT_EQ(count(right_margin, cv::Vec4b(18, 20, 24, 255)), 12 * sheet.rows);
}

std::vector<int> chosen_of(std::uint64_t pictures) {
    MomentCollector collector(4);
    for (std::uint64_t i = 0; i < pictures; ++i)
        if (collector.wants(i)) collector.add({std::to_string(i), {}, {}});
    std::vector<int> chosen;
    for (const FlightMoment& moment : collector.chosen()) chosen.push_back(std::stoi(moment.title));
    return chosen;
}

TEST(MomentCollector, KeepsAllOfAShortFlight) {
    EXPECT_EQ(chosen_of(3), (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(chosen_of(0), std::vector<int>{});
}

TEST(MomentCollector, SpreadsEvenlyOverAnyLength) {
    for (std::uint64_t pictures = 5; pictures < 3000; pictures += 7) {
        const std::vector<int> chosen = chosen_of(pictures);
        ASSERT_EQ(chosen.size(), 4u);
        EXPECT_EQ(chosen[0], 0);
        const double step = static_cast<double>(chosen[3]) / 3;
        EXPECT_GT(chosen[3], 0.7 * static_cast<double>(pictures - 1)) << pictures;
        for (int i = 1; i < 3; ++i) EXPECT_NEAR(chosen[i], i * step, 0.35 * step) << pictures;
    }
}

}  // namespace

}  // namespace vantage
