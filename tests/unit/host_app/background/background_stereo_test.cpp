#include "host_app/background/background_stereo.h"

#include <filesystem>
#include <iterator>

#include <gtest/gtest.h>

#include "common/wire/codec/colour_codec.h"
#include "host_app/background/background_stereo_task.h"
#include "tests/unit/host_app/refine/pole_before_wall.h"

namespace vantage {
namespace {

int pixels_at(const DepthImage& depth_m, float metres, const cv::Rect& where) {
    return cv::countNonZero(cv::abs(depth_m(where) - metres) < 0.05 * metres);
}

TEST(BackgroundStereo, FindsAThinThingThatWasTakenForWhatIsBehindIt) {
    const std::vector<BackgroundView> sets{background_with_pole(0), background_with_pole(-0.4), background_with_pole(0.4)};
    const DepthImage depth_m = match_backgrounds(sets).value().at(0);
    EXPECT_GT(pixels_at(depth_m, near_pole_m, pole_place), 0.9 * pole_place.area());
    const int others = matched_size.area() - pole_place.area();
    EXPECT_GT(pixels_at(depth_m, wall_behind_m, cv::Rect({0, 0}, matched_size)), 0.97 * others);
}

/// Before a wall a card, both painted at random; the rig itself knows the card's depth roughly, and
/// too broad.
BackgroundView background_with_card(double x_m, const cv::Rect& card) {
    BackgroundView set = background_with_pole(x_m, cv::Rect());
    const cv::Rect seen(card.x - static_cast<int>(std::lround(150 * x_m / near_pole_m)), card.y,
                        card.width, card.height);
    for (int y = 0; y < matched_size.height; ++y)
        for (int x = 0; x < matched_size.width; ++x) {
            const bool is_card = seen.contains({x, y});
            const long column =
                is_card ? x - seen.x : x + std::lround(150 * x_m / wall_behind_m) + 400;
            cv::RNG cell(static_cast<std::uint64_t>((column / 3 * 131 + y / 3) * 2 + is_card + 1));
            for (int c = 0; c < 3; ++c)
                set.colour(y, x)[c] = static_cast<uchar>(cell.uniform(20, 230));
        }
    const cv::Rect broader(seen.x - 6, seen.y, seen.width + 12, seen.height);
    set.depth_m(broader & cv::Rect({0, 0}, matched_size)) = 1.1f * near_pole_m;
    return set;
}

constexpr int poles = 14, pole_spacing_px = 12;

/// What a camera at x sees of a row of poles before a wall, all alike and of one colour each.
ColourImage row_of_poles(double x_m) {
    ColourImage seen(matched_size, cv::Vec4b(60, 140, 60, 255));
    const int shift = static_cast<int>(std::lround(150 * x_m / near_pole_m));
    for (int pole = 0; pole < poles; ++pole)
        seen(cv::Rect(pole * pole_spacing_px - shift, 20, 3, 80) & cv::Rect({0, 0}, matched_size)) =
            cv::Vec4b(220, 160, 230, 255);
    return seen;
}

/// A rig that takes all of that for the wall, and whose right sensor has other gains.
BackgroundView background_with_row_of_poles(double x_m, int right_pictures, const cv::Scalar& gains) {
    BackgroundView set = background_with_pole(x_m, cv::Rect());
    set.colour = row_of_poles(x_m);
    ColourImage seen = row_of_poles(x_m + set.baseline_m);
    cv::multiply(seen, gains, seen);
    const auto right = std::make_shared<const std::vector<std::byte>>(
        JpegEncoder().encode(seen, 95, Chroma::full));
    set.right_jpegs.assign(static_cast<std::size_t>(right_pictures), right);
    set.right_px = matched_size;
    return set;
}

/// Other rigs stand so far away that one pole may as well be the next one.
TEST(BackgroundStereo, TellsWhatLooksAlikeApartByTheRightPicture) {
    const cv::Rect pole(60, 30, 3, 60);
    const auto right_depths = [&](int right_pictures, const cv::Scalar& gains = {1, 1, 1, 1}) {
        const std::vector<BackgroundView> sets{background_with_row_of_poles(0, right_pictures, gains),
                                           background_with_row_of_poles(-0.4, right_pictures, gains),
                                           background_with_row_of_poles(0.4, right_pictures, gains)};
        return pixels_at(match_backgrounds(sets).value().at(0), near_pole_m, pole);
    };
    EXPECT_LT(right_depths(0), 0.3 * pole.area());
    EXPECT_GT(right_depths(3), 0.9 * pole.area());
    EXPECT_GT(right_depths(3, {0.75, 1, 0.8, 1}), 0.9 * pole.area());
}

/// Beside what is near lie strips of the wall that one or both of the other rigs cannot see.
TEST(BackgroundStereo, KnowsWhatIsHiddenFromOtherRigs) {
    const cv::Rect card(60, 20, 30, 80), left(48, 20, 12, 80), right(90, 20, 12, 80);
    const std::vector<BackgroundView> sets{background_with_card(0, card), background_with_card(-0.4, card),
                                       background_with_card(0.4, card)};
    const DepthImage depth_m = match_backgrounds(sets).value().at(0);
    EXPECT_GT(pixels_at(depth_m, near_pole_m, card), 0.9 * card.area());
    EXPECT_GT(pixels_at(depth_m, wall_behind_m, left), 0.8 * left.area());
    EXPECT_GT(pixels_at(depth_m, wall_behind_m, right), 0.8 * right.area());
}

TEST(BackgroundStereo, StaysWithTheRigsOwnDepthWhereThePicturesSayNothing) {
    std::vector<BackgroundView> sets{background_with_pole(0), background_with_pole(-0.4), background_with_pole(0.4)};
    for (BackgroundView& set : sets) {
        set.colour = cv::Vec4b(120, 120, 120, 255);
        set.depth_m(cv::Rect(0, 0, 80, 120)) = 3;
    }
    const DepthImage depth_m = match_backgrounds(sets).value().at(0);
    // Where both others see all depths.
    const cv::Rect nearer(40, 0, 38, 120), farther(82, 0, 38, 120);
    EXPECT_EQ(pixels_at(depth_m, 3, nearer), nearer.area());
    EXPECT_EQ(pixels_at(depth_m, wall_behind_m, farther), farther.area());
}

TEST(BackgroundStereo, LeavesOutWhatIsNotKnown) {
    std::vector<BackgroundView> sets{background_with_pole(0), background_with_pole(-0.4), background_with_pole(0.4)};
    const cv::Rect unknown(20, 30, 20, 40);
    sets[0].colour(unknown) = cv::Vec4b(0, 0, 0, 0);
    // Performers stand before one place of the wall in both others' pictures.
    sets[1].colour(cv::Rect(135, 30, 20, 40)) = cv::Vec4b(60, 140, 60, 0);
    sets[2].colour(cv::Rect(105, 30, 20, 40)) = cv::Vec4b(60, 140, 60, 0);
    const DepthImage depth_m = match_backgrounds(sets).value().at(0);
    EXPECT_EQ(cv::countNonZero(depth_m(unknown)), 0);
    const cv::Rect behind(120, 30, 20, 40);
    EXPECT_GT(pixels_at(depth_m, wall_behind_m, behind), 0.9 * behind.area());
    EXPECT_GT(pixels_at(depth_m, near_pole_m, pole_place), 0.9 * pole_place.area());
}

TEST(BackgroundStereo, HasNothingToTellWithoutRigsThatStandApart) {
    const std::vector<BackgroundView> alone{background_with_pole(0)};
    EXPECT_EQ(cv::countNonZero(match_backgrounds(alone).value().at(0)), 0);
    const std::vector<BackgroundView> close{background_with_pole(0), background_with_pole(0.2)};
    EXPECT_EQ(cv::countNonZero(match_backgrounds(close).value().at(0)), 0);
}

TEST(BackgroundStereo, TakesSetsOfWhichNothingIsKnown) {
    std::vector<BackgroundView> sets{background_with_pole(0), background_with_pole(0.4)};
    for (BackgroundView& set : sets) set.depth_m = 0.0f;
    EXPECT_EQ(cv::countNonZero(match_backgrounds(sets).value().at(0)), 0);
}

TEST(BackgroundStereo, StopsWhenAsked) {
    std::stop_source stop;
    stop.request_stop();
    const std::vector<BackgroundView> sets{background_with_pole(0), background_with_pole(0.4)};
    EXPECT_FALSE(match_backgrounds(sets, stop.get_token()));
}

class BackgroundStereoTaskTest : public testing::TestWithParam<BackgroundStereoTask::Manner> {};

TEST_P(BackgroundStereoTaskTest, GivesWhatWasMatchedOnce) {
    BackgroundStereoTask matching;
    EXPECT_FALSE(matching.take(true));
    const std::vector<BackgroundView> sets{background_with_pole(0), background_with_pole(-0.4)};
    matching.begin(sets, GetParam());
    EXPECT_TRUE(matching.is_under_way());
    const std::vector<DepthImage> depths_m = matching.take(true).value();
    ASSERT_EQ(depths_m.size(), 2u);
    EXPECT_EQ(cv::norm(depths_m[1], match_backgrounds(sets).value()[1], cv::NORM_INF), 0);
    EXPECT_FALSE(matching.is_under_way());
    EXPECT_FALSE(matching.take(true));
}

TEST_P(BackgroundStereoTaskTest, CanBeGivenUp) {
    BackgroundStereoTask matching;
    matching.begin({background_with_pole(0), background_with_pole(-0.4)}, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Manners, BackgroundStereoTaskTest,
                         testing::Values(BackgroundStereoTask::Manner::beside,
                                         BackgroundStereoTask::Manner::when_waited_for));

std::ptrdiff_t threads() {
    using Entries = std::filesystem::directory_iterator;
    return std::distance(Entries("/proc/self/task"), Entries());
}

TEST(BackgroundStereoTask, HasNoThreadOfItsOwnWhereItIsWaitedFor) {
    BackgroundStereoTask matching;
    const std::ptrdiff_t before = threads();
    matching.begin({background_with_pole(0), background_with_pole(-0.4)}, BackgroundStereoTask::Manner::when_waited_for);
    EXPECT_EQ(threads(), before);
    EXPECT_FALSE(matching.take());
    EXPECT_TRUE(matching.take(true));
}

}  // namespace
}  // namespace vantage
