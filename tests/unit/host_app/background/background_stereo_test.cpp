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

TEST(BackgroundStereo, FindsAThinPoleThatTheMatcherMissed) {
    const std::vector<BackgroundView> views{background_with_pole(0), background_with_pole(-0.4),
                                            background_with_pole(0.4)};
    const DepthImage depth_m = match_backgrounds(views, MatchedSize::whole).value().at(0);
    EXPECT_GT(pixels_at(depth_m, near_pole_m, pole_place), 0.9 * pole_place.area());
    const int others = matched_size.area() - pole_place.area();
    EXPECT_GT(pixels_at(depth_m, wall_behind_m, cv::Rect({0, 0}, matched_size)), 0.97 * others);
}

/// A card before a wall, both with random patterns. The rig's own depth of the card is rough and
/// too broad.
BackgroundView background_with_card(double x_m, const cv::Rect& card) {
    BackgroundView view = background_with_pole(x_m, cv::Rect());
    const cv::Rect seen(card.x - static_cast<int>(std::lround(150 * x_m / near_pole_m)), card.y,
                        card.width, card.height);
    for (int y = 0; y < matched_size.height; ++y)
        for (int x = 0; x < matched_size.width; ++x) {
            const bool is_card = seen.contains({x, y});
            const long column =
                is_card ? x - seen.x : x + std::lround(150 * x_m / wall_behind_m) + 400;
            cv::RNG cell(static_cast<std::uint64_t>((column / 3 * 131 + y / 3) * 2 + is_card + 1));
            for (int c = 0; c < 3; ++c)
                view.colour(y, x)[c] = static_cast<uchar>(cell.uniform(20, 230));
        }
    const cv::Rect broader(seen.x - 6, seen.y, seen.width + 12, seen.height);
    view.depth_m(broader & cv::Rect({0, 0}, matched_size)) = 1.1f * near_pole_m;
    return view;
}

constexpr int poles = 14, pole_spacing_px = 12;

/// The picture of a camera at x of a row of identical poles before a plain wall.
ColourImage row_of_poles(double x_m) {
    ColourImage seen(matched_size, cv::Vec4b(60, 140, 60, 255));
    const int shift = static_cast<int>(std::lround(150 * x_m / near_pole_m));
    for (int pole = 0; pole < poles; ++pole)
        seen(cv::Rect(pole * pole_spacing_px - shift, 20, 3, 80) & cv::Rect({0, 0}, matched_size)) =
            cv::Vec4b(220, 160, 230, 255);
    return seen;
}

/// A rig whose matcher misses the poles and whose right sensor has other gains.
BackgroundView background_with_row_of_poles(double x_m, int right_pictures,
                                            const cv::Scalar& gains) {
    BackgroundView view = background_with_pole(x_m, cv::Rect());
    view.colour = row_of_poles(x_m);
    ColourImage seen = row_of_poles(x_m + view.baseline_m);
    cv::multiply(seen, gains, seen);
    const auto right = std::make_shared<const std::vector<std::byte>>(
        JpegEncoder().encode(seen, 95, Chroma::full));
    view.right_jpegs.assign(static_cast<std::size_t>(right_pictures), right);
    view.right_px = matched_size;
    return view;
}

/// The other rigs stand so far apart that they may confuse one pole with the next.
TEST(BackgroundStereo, ResolvesRepetitiveStructureWithTheRightImage) {
    const cv::Rect pole(60, 30, 3, 60);
    const auto right_depths = [&](int right_pictures, const cv::Scalar& gains = {1, 1, 1, 1}) {
        const std::vector<BackgroundView> views{
            background_with_row_of_poles(0, right_pictures, gains),
            background_with_row_of_poles(-0.4, right_pictures, gains),
            background_with_row_of_poles(0.4, right_pictures, gains)};
        return pixels_at(match_backgrounds(views, MatchedSize::whole).value().at(0), near_pole_m,
                         pole);
    };
    EXPECT_LT(right_depths(0), 0.3 * pole.area());
    EXPECT_GT(right_depths(3), 0.9 * pole.area());
    EXPECT_GT(right_depths(3, {0.75, 1, 0.8, 1}), 0.9 * pole.area());
}

/// Beside the card lie strips of the wall that one or both of the other rigs cannot see.
TEST(BackgroundStereo, HandlesOcclusionsInOtherRigs) {
    const cv::Rect card(60, 20, 30, 80), left(48, 20, 12, 80), right(90, 20, 12, 80);
    const std::vector<BackgroundView> views{background_with_card(0, card),
                                            background_with_card(-0.4, card),
                                            background_with_card(0.4, card)};
    const DepthImage depth_m = match_backgrounds(views, MatchedSize::whole).value().at(0);
    EXPECT_GT(pixels_at(depth_m, near_pole_m, card), 0.9 * card.area());
    EXPECT_GT(pixels_at(depth_m, wall_behind_m, left), 0.8 * left.area());
    EXPECT_GT(pixels_at(depth_m, wall_behind_m, right), 0.8 * right.area());
}

TEST(BackgroundStereo, FindsSurfacesInHalfTheSizeOfOddPictures) {
    const cv::Rect card(60, 20, 30, 80), odd(0, 0, matched_size.width - 1, matched_size.height - 1);
    std::vector<BackgroundView> views{background_with_card(0, card),
                                      background_with_card(-0.4, card),
                                      background_with_card(0.4, card)};
    for (BackgroundView& view : views) {
        view.colour = view.colour(odd).clone();
        view.depth_m = view.depth_m(odd).clone();
    }
    const DepthImage depth_m = match_backgrounds(views, MatchedSize::half).value().at(0);
    ASSERT_EQ(depth_m.size(), odd.size());
    EXPECT_GT(pixels_at(depth_m, near_pole_m, card), 0.9 * card.area());
    const cv::Rect left(0, 0, 40, odd.height), right(100, 0, 40, odd.height);
    EXPECT_GT(pixels_at(depth_m, wall_behind_m, left), 0.9 * left.area());
    EXPECT_GT(pixels_at(depth_m, wall_behind_m, right), 0.9 * right.area());
}

TEST(BackgroundStereo, KeepsTheRigsOwnDepthOnPlainSurfaces) {
    std::vector<BackgroundView> views{background_with_pole(0), background_with_pole(-0.4),
                                      background_with_pole(0.4)};
    for (BackgroundView& view : views) {
        view.colour = cv::Vec4b(120, 120, 120, 255);
        view.depth_m(cv::Rect(0, 0, 80, 120)) = 3;
    }
    const DepthImage depth_m = match_backgrounds(views, MatchedSize::whole).value().at(0);
    // Regions whose depths are all in both other pictures.
    const cv::Rect nearer(40, 0, 38, 120), farther(82, 0, 38, 120);
    EXPECT_EQ(pixels_at(depth_m, 3, nearer), nearer.area());
    EXPECT_EQ(pixels_at(depth_m, wall_behind_m, farther), farther.area());
}

/// The background of a rig at x, 1.5 m above a floor (y = 0) before a wall. The floor has a pattern
/// on the left only; on its right, the rig's own depth is wavy.
BackgroundView background_with_floor(double x_m) {
    BackgroundView view;
    view.K << 150, 0, 80, 0, 150, 60, 0, 0, 1;
    view.world_from_camera.translation() = Eigen::Vector3d(x_m, -1.5, 0);
    view.baseline_m = 0.15;
    view.colour = ColourImage(matched_size, cv::Vec4b(150, 150, 150, 255));
    view.depth_m = DepthImage(matched_size);
    for (int y = 0; y < matched_size.height; ++y)
        for (int x = 0; x < matched_size.width; ++x) {
            const double z_m = 1 / std::max(1.0 / 8, (y - 60) / (150 * 1.5)),
                         at_m = x_m + z_m * (x - 80) / 150;
            const bool is_plain = z_m < 7.99 && at_m > 0;
            view.depth_m(y, x) = static_cast<float>(
                is_plain ? z_m * (1 + 0.05 * std::sin(x / 9.0) * std::sin(y / 7.0)) : z_m);
            if (is_plain) continue;
            const long column = std::lround(at_m * 12),
                       row = z_m < 7.99 ? std::lround(z_m * 12) : y;
            cv::RNG cell(static_cast<std::uint64_t>((column + 400) * 1000 + row + 1));
            for (int c = 0; c < 3; ++c)
                view.colour(y, x)[c] = static_cast<uchar>(cell.uniform(20, 230));
        }
    return view;
}

TEST(BackgroundStereo, ContinuesAPlaneWhereItIsPlain) {
    const std::vector<BackgroundView> views{background_with_floor(0), background_with_floor(-0.5),
                                            background_with_floor(0.5)};
    const DepthImage depth_m = match_backgrounds(views, MatchedSize::whole).value().at(0);
    int plain = 0, on_floor = 0;
    for (int y = 92; y < matched_size.height; ++y)
        for (int x = 85; x < 140; ++x) {
            ++plain;
            if (std::abs(depth_m(y, x) * (y - 60) / (150 * 1.5) - 1) < 0.005) ++on_floor;
        }
    EXPECT_GT(on_floor, 0.9 * plain);
}

TEST(BackgroundStereo, IgnoresUnknownPixels) {
    std::vector<BackgroundView> views{background_with_pole(0), background_with_pole(-0.4),
                                      background_with_pole(0.4)};
    const cv::Rect unknown(20, 30, 20, 40);
    views[0].colour(unknown) = cv::Vec4b(0, 0, 0, 0);
    // Foreground hides one place of the wall in both other pictures.
    views[1].colour(cv::Rect(135, 30, 20, 40)) = cv::Vec4b(60, 140, 60, 0);
    views[2].colour(cv::Rect(105, 30, 20, 40)) = cv::Vec4b(60, 140, 60, 0);
    const DepthImage depth_m = match_backgrounds(views, MatchedSize::whole).value().at(0);
    EXPECT_EQ(cv::countNonZero(depth_m(unknown)), 0);
    const cv::Rect behind(120, 30, 20, 40);
    EXPECT_GT(pixels_at(depth_m, wall_behind_m, behind), 0.9 * behind.area());
    EXPECT_GT(pixels_at(depth_m, near_pole_m, pole_place), 0.9 * pole_place.area());
}

TEST(BackgroundStereo, ReturnsNoDepthWithoutRigsThatStandApart) {
    const std::vector<BackgroundView> alone{background_with_pole(0)};
    EXPECT_EQ(cv::countNonZero(match_backgrounds(alone, MatchedSize::whole).value().at(0)), 0);
    const std::vector<BackgroundView> close{background_with_pole(0), background_with_pole(0.2)};
    EXPECT_EQ(cv::countNonZero(match_backgrounds(close, MatchedSize::whole).value().at(0)), 0);
}

TEST(BackgroundStereo, AcceptsBackgroundsOfWhichNothingIsKnown) {
    std::vector<BackgroundView> views{background_with_pole(0), background_with_pole(0.4)};
    for (BackgroundView& view : views) view.depth_m = 0.0f;
    EXPECT_EQ(cv::countNonZero(match_backgrounds(views, MatchedSize::whole).value().at(0)), 0);
}

TEST(BackgroundStereo, StopsWhenAsked) {
    std::stop_source stop;
    stop.request_stop();
    const std::vector<BackgroundView> views{background_with_pole(0), background_with_pole(0.4)};
    EXPECT_FALSE(match_backgrounds(views, MatchedSize::whole, stop.get_token()));
}

class BackgroundStereoTaskTest : public testing::TestWithParam<BackgroundStereoTask::Manner> {};

TEST_P(BackgroundStereoTaskTest, ReturnsItsResultOnce) {
    BackgroundStereoTask matching;
    EXPECT_FALSE(matching.take(true));
    const std::vector<BackgroundView> views{background_with_pole(0), background_with_pole(-0.4)};
    matching.begin(views, MatchedSize::whole, GetParam());
    EXPECT_TRUE(matching.is_under_way());
    const std::vector<DepthImage> depths_m = matching.take(true).value();
    ASSERT_EQ(depths_m.size(), 2u);
    EXPECT_EQ(cv::norm(depths_m[1], match_backgrounds(views, MatchedSize::whole).value()[1],
                       cv::NORM_INF),
              0);
    EXPECT_FALSE(matching.is_under_way());
    EXPECT_FALSE(matching.take(true));
}

TEST_P(BackgroundStereoTaskTest, CanBeAbandoned) {
    BackgroundStereoTask matching;
    matching.begin({background_with_pole(0), background_with_pole(-0.4)}, MatchedSize::whole,
                   GetParam());
}

INSTANTIATE_TEST_SUITE_P(Manners, BackgroundStereoTaskTest,
                         testing::Values(BackgroundStereoTask::Manner::beside,
                                         BackgroundStereoTask::Manner::when_waited_for));

std::ptrdiff_t threads() {
    using Entries = std::filesystem::directory_iterator;
    return std::distance(Entries("/proc/self/task"), Entries());
}

TEST(BackgroundStereoTask, StartsNoThreadIfTheCallerWaits) {
    BackgroundStereoTask matching;
    const std::ptrdiff_t before = threads();
    matching.begin({background_with_pole(0), background_with_pole(-0.4)}, MatchedSize::whole,
                   BackgroundStereoTask::Manner::when_waited_for);
    EXPECT_EQ(threads(), before);
    EXPECT_FALSE(matching.take());
    EXPECT_TRUE(matching.take(true));
}

}  // namespace
}  // namespace vantage
