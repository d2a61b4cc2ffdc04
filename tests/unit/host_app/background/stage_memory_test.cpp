// Learning of a background over time on the virtual stage, with real stereo matching and the
// stage's own time.
#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/gl/context/egl_context.h"
#include "host_app/fused/staged_preparer.h"
#include "tests/bench/synthesis/truth_regions.h"
#include "tests/unit/host_app/surfaces/painted_rig.h"

namespace vantage {
namespace {

using std::chrono::milliseconds;

constexpr double dt_s = 0.2;
constexpr milliseconds dt{200};

class StageMemoryTest : public testing::Test {
  protected:
    const RigSurface& prepared(const DepthView& view) {
        preparer_.take({&view, 1}, dt_s);
        constexpr std::size_t without_others = 2;
        instant_ = preparer_.prepare(
            {PaintedRig::size.width, PaintedRig::size.height, view.K, view.world_from_camera},
            prepare_levels()[without_others]);
        return *instant_->rigs.at(0).surface;
    }
    const RigSurface& surface() const { return *instant_->rigs.at(0).surface; }
    /// The depth of foreground and background together.
    DepthImage depth_m() const {
        const RigSurface& performers = *instant_->rigs.at(0).boundary;
        DepthImage depth_m(surface().depth().download());
        const DepthImage before_m(performers.depth().download());
        cv::Mat1b share;
        cv::extractChannel(performers.colour().download(), share, 3);
        before_m.copyTo(depth_m, (share >= 128) & (before_m > 0));
        return depth_m;
    }
    ColourImage colour() const {
        const ColourImage performers = instant_->rigs.at(0).boundary->colour().download();
        ColourImage colour = surface().colour().download();
        for (int y = 0; y < colour.rows; ++y)
            for (int x = 0; x < colour.cols; ++x) {
                const cv::Vec4b& before = performers(y, x);
                colour(y, x) = colour(y, x) * (1 - before[3] / 255.0) + before;
            }
        return colour;
    }
    /// The background, also behind the foreground, and where it is known.
    struct Plate {
        ColourImage colour;
        DepthImage depth_m;
        cv::Mat1b known;
    };
    Plate plate() {
        return {surface().colour().download(), DepthImage(surface().depth().download()),
                BackgroundModel::known(preparer_.background_access()->learnt().rigs.at(0), dt_s)};
    }
    /// The share of the pixels of a mask at which two depths are one surface. Inpainted depth is
    /// negative.
    static double share_alike(const DepthImage& a, const DepthImage& b, const cv::Mat1b& where) {
        constexpr double one_surface = 0.12;
        int alike = 0, all = 0;
        for (int y = 0; y < a.rows; ++y)
            for (int x = 0; x < a.cols; ++x) {
                if (!where(y, x)) continue;
                ++all;
                alike += std::abs(std::abs(a(y, x)) / b(y, x) - 1) < one_surface ? 1 : 0;
            }
        return alike / static_cast<double>(std::max(all, 1));
    }
    /// The depth of the rig's own matcher.
    static DepthImage matched_m(const DepthView& view) {
        DepthImage depth_m(view.depth_size());
        for (int y = 0; y < depth_m.rows; ++y)
            for (int x = 0; x < depth_m.cols; ++x) depth_m(y, x) = view.depth_m_at(x, y);
        return depth_m;
    }
    static double share_of(const cv::Mat1b& mask, const cv::Mat1b& where) {
        return cv::countNonZero(mask & where) /
               static_cast<double>(std::max(cv::countNonZero(where), 1));
    }
    static cv::Mat1b eroded(const cv::Mat1b& mask, int by_px) {
        cv::Mat1b less;
        cv::erode(mask, less, cv::Mat1b::ones(2 * by_px + 1, 2 * by_px + 1));
        return less;
    }
    static cv::Mat1b wider(const cv::Mat1b& mask, int by_px) {
        cv::Mat1b more;
        cv::dilate(mask, more, cv::Mat1b::ones(2 * by_px + 1, 2 * by_px + 1));
        return more;
    }
    /// An image as the cheaper levels interpolate it.
    static ColourImage sharpened(const ColourImage& image) {
        constexpr float s = bilinear_sharpening;
        const cv::Mat1f kernel = (cv::Mat1f(3, 3) << 0, -s, 0, -s, 1 + 4 * s, -s, 0, -s, 0);
        ColourImage sharp;
        cv::filter2D(image, sharp, -1, kernel, {-1, -1}, 0, cv::BORDER_REPLICATE);
        return sharp;
    }
    /// Mean over red, green and blue, in grey levels.
    static double mean_cost(const ColourImage& a, const ColourImage& b, const cv::Mat1b& where) {
        cv::Mat off;
        cv::absdiff(a, b, off);
        const cv::Scalar mean = cv::mean(off, where);
        return (mean[0] + mean[1] + mean[2]) / 3;
    }

    EglContext context_;
    ShaderLibrary shaders_;
    VirtualStage stage_{shaders_};
    PaintedRig rig_{shaders_};
    StagedPreparer preparer_{shaders_};
    std::shared_ptr<const Instant> instant_;
};

Card chair_at(double x_m) {
    return {{x_m, 0.55, 0.6}, 0.28, 0.45, [](double across, double up) {
                return cell_colour(static_cast<int>(std::floor(5 * across)),
                                   static_cast<int>(std::floor(8 * up)), 3);
            }};
}

TEST_F(StageMemoryTest, AMovedChairIsSeenWhereItStandsAndLeavesNoGhost) {
    rig_.look(stage_, dt);
    const StageRendering bare = rig_.seen();
    rig_.look(stage_, dt, {chair_at(-0.75)});
    const cv::Mat1b old_place = rig_.seen().depth_m < 0.99 * bare.depth_m;
    for (int i = 0; i < 15; ++i) prepared(rig_.film());
    rig_.look(stage_, dt, {chair_at(0.75)});
    const StageRendering moved = rig_.seen();
    const cv::Mat1b new_place = moved.depth_m < 0.99 * bare.depth_m;
    ASSERT_GT(cv::countNonZero(old_place & ~new_place), 300);
    prepared(rig_.film());
    EXPECT_GT(share_alike(depth_m(), moved.depth_m, eroded(new_place, 2)), 0.9) << "at once";
    DepthView view;
    for (int i = 0; i < 4; ++i) prepared(view = rig_.film());
    const double own = share_alike(matched_m(view), moved.depth_m, eroded(old_place, 2));
    EXPECT_GT(share_alike(depth_m(), moved.depth_m, eroded(old_place, 2)), own - 0.1)
        << "the matcher: " << own;
    EXPECT_LT(mean_cost(surface().colour().download(), sharpened(moved.colour), old_place), 4);
    // The background in its old place is known again after a second.
    for (int i = 0; i < 6; ++i) prepared(rig_.film());
    const Plate behind = plate();
    EXPECT_GT(share_of(behind.known, eroded(old_place, 2)), 0.9);
    EXPECT_LT(
        mean_cost(behind.colour, sharpened(moved.colour), eroded(old_place, 2) & behind.known), 4);
}

TEST_F(StageMemoryTest, LightThatFadesByHalfInFiveSecondsIsBackground) {
    rig_.look(stage_, dt);
    for (int i = 0; i < 15; ++i) prepared(rig_.film());
    const DepthImage before_m = depth_m();
    const cv::Mat1b everywhere(PaintedRig::size, uchar{255});
    for (int i = 1; i <= 25; ++i) {
        const DepthView view = rig_.film(1 - 0.5 * i / 25);
        prepared(view);
        // No background is classified as foreground, and it does not lag behind the light.
        const cv::Mat1b nearer = cv::abs(depth_m()) < 0.88 * cv::abs(before_m);
        ASSERT_LT(share_of(nearer, everywhere), 0.025) << "instant " << i;
        ASSERT_LT(mean_cost(surface().colour().download(), sharpened(view.colour), everywhere), 5)
            << "instant " << i;
    }
    EXPECT_GT(share_of(plate().known, everywhere), 0.9);
}

TEST_F(StageMemoryTest, APerformerWhoStandsStillForHalfAMinuteIsNotLearnt) {
    const TruthRegions regions(stage_, rig_.camera());
    milliseconds time{2000};
    for (int i = 0; i < 40; ++i, time += dt) {
        rig_.look(stage_, time);
        prepared(rig_.film());
    }
    // Places that were hidden all the time are unknown.
    const cv::Mat1b was_known = plate().known;
    const DepthImage set_m = plate().depth_m;
    DepthView view;
    for (double s = 0; s < 30; s += dt_s) prepared(view = rig_.film());
    const cv::Mat1b performers = eroded(regions.performers(rig_.seen().depth_m), 2);
    const cv::Mat1b known_behind = performers & was_known;
    ASSERT_GT(cv::countNonZero(known_behind), 200);
    const double own = share_alike(matched_m(view), rig_.seen().depth_m, known_behind);
    // As much of the performer as the matcher itself has right.
    ASSERT_GT(own, 0.7);
    EXPECT_GT(share_alike(depth_m(), rig_.seen().depth_m, known_behind), 0.95 * own);
    EXPECT_GT(share_of(plate().known, known_behind), 0.98);
    // The model is of ten instants, and nothing refines it here.
    EXPECT_GT(share_alike(plate().depth_m, set_m, known_behind), 0.98);
}

/// A wall of pictures that move, and rows of people who never stand still and hide what is behind
/// them.
TEST_F(StageMemoryTest, WhereNothingIsStillThereIsNoBackground) {
    const auto cards_at = [](double s) {
        std::vector<Card> cards;
        cards.push_back({{0.9, 1.5, -1.8}, 0.7, 0.5, [s](double across, double up) {
                             return cell_colour(static_cast<int>(std::floor(8 * across + 9 * s)),
                                                static_cast<int>(std::floor(6 * up - 4 * s)), 5);
                         }});
        for (int row = 0; row < 3; ++row)
            for (int i = 0; i < 7; ++i) {
                const double phase = 2.1 * i + 1.3 * row;
                const double sway = 0.1 * std::sin(7.1 * s + phase);
                const auto seed = static_cast<std::uint64_t>(10 * row + i + 20);
                cards.push_back(
                    {{-1.7 + 0.2 * i + sway, 0.9 + 0.12 * row + 0.08 * std::sin(9.3 * s + phase),
                      -1.2 - 0.4 * row + 0.15 * std::sin(6.3 * s + 2 * phase)},
                     0.17,
                     0.6,
                     [seed, s](double across, double up) {
                         return cell_colour(static_cast<int>(std::floor(3 * across + 2 * s)),
                                            static_cast<int>(std::floor(7 * up)), seed);
                     }});
            }
        return cards;
    };
    const milliseconds still{2000};
    rig_.look(stage_, still);
    const DepthImage bare_m = rig_.seen().depth_m;
    DepthView view;
    cv::Mat1b always;
    for (int i = 0; i < 50; ++i) {
        rig_.look(stage_, still, cards_at(i * dt_s));
        const cv::Mat1b moves = rig_.seen().depth_m < 0.99 * bare_m;
        always = always.empty() ? moves : cv::Mat1b(always & moves);
        view = rig_.film();
        prepared(view);
    }
    always = eroded(always, 3);
    const cv::Mat1b calm = ~wider(rig_.seen().depth_m < 0.99 * bare_m, 12);
    ASSERT_GT(cv::countNonZero(always), 400);
    ASSERT_GT(cv::countNonZero(calm), 5000);
    EXPECT_LT(share_of(plate().known, always), 0.05);
    EXPECT_GT(share_of(plate().known, calm), 0.95);
    const double known = preparer_.background_access()->states().at(0).known;
    EXPECT_LT(known, 1 - 0.8 * cv::countNonZero(always) / static_cast<double>(always.total()));
    // The picture there is of this instant, in colour and in depth.
    EXPECT_LT(mean_cost(colour(), sharpened(view.colour), always), 1);
    const double own = share_alike(matched_m(view), rig_.seen().depth_m, always);
    // Cards overlap at every other pixel, and performers' depth goes on beyond their edges.
    EXPECT_GT(share_alike(depth_m(), rig_.seen().depth_m, always), own - 0.1)
        << "the matcher: " << own;
    // A saved background has a low certainty there too.
    const RigBackground saved = preparer_.background_access()->learnt().rigs.at(0);
    cv::Mat1b colour_certainty;
    cv::extractChannel(saved.colour, colour_certainty, 3);
    EXPECT_LT(cv::mean(cv::min(colour_certainty, saved.certainty), always)[0],
              0.3 * cv::mean(cv::min(colour_certainty, saved.certainty), calm)[0]);
}

}  // namespace
}  // namespace vantage
