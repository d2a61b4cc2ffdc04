#include <gtest/gtest.h>

#include "host_app/programme/view_painter.h"
#include "host_app/synthesis/synthesiser.h"

namespace vantage {
namespace {

constexpr unsigned char seen = 255, filled = 64;

ColourImage picture_of(unsigned char alpha) {
    return ColourImage(179, 321, cv::Vec4b(200, 120, 60, alpha));
}

bool is_marked(const cv::Vec4b& pixel) { return pixel[0] < 60 && pixel[1] < 60 && pixel[2] < 60; }

int changed(const ColourImage& a, const ColourImage& b) {
    int count = 0;
    for (int y = 0; y < a.rows; ++y)
        for (int x = 0; x < a.cols; ++x) count += a(y, x) != b(y, x);
    return count;
}

TEST(MarkUnseen, KeepsSeenAndRememberedPixels) {
    for (const unsigned char alpha : {seen, remembered_alpha}) {
        ColourImage picture = picture_of(alpha);
        mark_unseen(picture);
        EXPECT_EQ(changed(picture, picture_of(alpha)), 0);
    }
}

TEST(MarkUnseen, KeepsSmallInpaintedHoles) {
    ColourImage picture = picture_of(seen);
    picture(cv::Rect(100, 50, 24, 80)).setTo(cv::Vec4b(10, 200, 10, filled));
    const ColourImage before = picture.clone();
    mark_unseen(picture);
    EXPECT_EQ(changed(picture, before), 0);
}

TEST(MarkUnseen, MarksPixelsFarFromAllSeenOnes) {
    ColourImage picture = picture_of(filled);
    picture(cv::Rect(0, 0, 160, 179)).setTo(cv::Vec4b(200, 120, 60, seen));
    const ColourImage before = picture.clone();
    mark_unseen(picture);
    EXPECT_EQ(changed(picture(cv::Rect(0, 0, 160, 179)), before(cv::Rect(0, 0, 160, 179))), 0);
    EXPECT_EQ(changed(picture(cv::Rect(160, 0, 12, 179)), before(cv::Rect(160, 0, 12, 179))), 0)
        << "next to seen pixels";
    for (const cv::Point p : {cv::Point(205, 90), cv::Point(320, 0), cv::Point(320, 178)})
        EXPECT_TRUE(is_marked(picture(p))) << p;
    EXPECT_NE(picture(90, 300), picture(90, 305)) << "hatched";
    EXPECT_EQ(picture(90, 300)[3], filled) << "alpha stays";
}

TEST(MarkUnseen, KeepsSeenPixelsWithinAMarkedArea) {
    ColourImage picture = picture_of(filled);
    for (int y = 0; y < picture.rows; ++y) picture(y, 160)[3] = seen;
    mark_unseen(picture);
    for (int y = 0; y < picture.rows; ++y)
        EXPECT_EQ(picture(y, 160), cv::Vec4b(200, 120, 60, seen));
}

TEST(MarkUnseen, MarksAnEmptyFrameAndAcceptsTheSmallest) {
    ColourImage picture = picture_of(0);
    mark_unseen(picture);
    for (const cv::Vec4b& pixel : picture) ASSERT_TRUE(is_marked(pixel));
    ColourImage one(1, 1, cv::Vec4b(1, 2, 3, seen)), none;
    mark_unseen(one);
    EXPECT_EQ(one(0, 0), cv::Vec4b(1, 2, 3, seen));
    mark_unseen(none);
}

}  // namespace
}  // namespace vantage
