// A minute of the stage, at dates years apart: what moves, how smoothly and how fast, and that all
// who film it see one instant.
#include <chrono>
#include <cmath>
#include <optional>
#include <thread>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/gl/context/egl_context.h"
#include "common/virtual_stage/performer.h"
#include "common/virtual_stage/stage_scene.h"
#include "common/virtual_stage/virtual_stage.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;
using Eigen::Vector3d;
using std::chrono::nanoseconds;

/// Noon in November 2026, and some years on.
constexpr nanoseconds a_day = 1'795'348'800s, years_later = 4'106'620'800s;

StageCamera small_camera(const Vector3d& eye_m) {
    StageCamera camera;
    camera.width_px = 80;
    camera.height_px = 60;
    camera.K << 86, 0, 39.5, 0, 86, 29.5, 0, 0, 1;
    camera.world_from_camera = look_at(eye_m, {0, 1, 0});
    return camera;
}

class StageMotion : public testing::Test {
  protected:
    StageRendering film(nanoseconds time) { return stage_.render(camera_, time); }
    DepthImage film_depth_m(nanoseconds time) {
        return stage_.render(camera_, time, {.pictures = StagePictures::depth}).depth_m;
    }

    /// The depth without performers: every pixel's farthest depth in a loop.
    DepthImage set_m() {
        DepthImage farthest_m;
        for (int i = 0; i < 16; ++i) {
            const DepthImage depth_m = film_depth_m(a_day + i * stage_loop / 16);
            farthest_m = i == 0 ? depth_m : DepthImage(cv::max(farthest_m, depth_m));
        }
        return farthest_m;
    }

    EglContext context_;
    ShaderLibrary library_;
    VirtualStage stage_{library_};
    StageCamera camera_ = small_camera({0.8, 1.8, 4.4});
};

/// 255 where performers stand in front of the scenery.
cv::Mat1b performers(const DepthImage& depth_m, const DepthImage& set_m) {
    return depth_m < set_m - 0.03;
}

TEST_F(StageMotion, PerformersMoveAndSceneryStandsStillAtAnyDate) {
    const DepthImage set_m = this->set_m();
    // Performers' shadows do not reach the walls.
    const cv::Mat1b walls = set_m > 7.5;
    ASSERT_GT(cv::countNonZero(walls), 80 * 60 / 5);
    const ColourImage first = film(a_day).colour;
    cv::Mat1b of_first;
    cv::dilate(performers(film_depth_m(a_day), set_m), of_first, cv::Mat1b(5, 5, 255));
    for (const nanoseconds date : {a_day, years_later, nanoseconds(0)}) {
        cv::Mat1i covered(set_m.size(), 0);
        constexpr int instants = 14;
        for (int i = 0; i < instants; ++i) {
            const nanoseconds time = date + i * 4300ms;
            const StageRendering now = film(time), next = film(time + 40ms),
                                 later = film(time + 1s);
            const cv::Mat1b here = performers(now.depth_m, set_m),
                            there = performers(next.depth_m, set_m),
                            elsewhere = performers(later.depth_m, set_m);
            const int pixels = cv::countNonZero(here);
            EXPECT_GT(pixels, 80 * 60 / 20);
            EXPECT_LT(pixels, 80 * 60 / 3);
            cv::Mat1i one;
            here.convertTo(one, CV_32S, 1.0 / 255);
            covered += one;
            cv::Mat1b near_them;
            cv::dilate(here, near_them, cv::Mat1b(5, 5, 255));
            // The scenery is unchanged, to the last bit.
            const cv::Mat moved = (now.depth_m != set_m) & ~near_them;
            EXPECT_EQ(cv::countNonZero(moved), 0);
            const cv::Mat still = walls & ~near_them & ~of_first;
            EXPECT_GT(cv::countNonZero(still), 300);
            // A hand between the pixels' centres shows in colour, and not in depth.
            EXPECT_LT(cv::norm(now.colour, first, cv::NORM_L1, still), 60);
            // In a second they have walked on; in 40 ms a little of their outline has.
            EXPECT_GT(cv::countNonZero(here != elsewhere), pixels / 3);
            EXPECT_GT(cv::norm(now.depth_m, next.depth_m, cv::NORM_L1), 0);
            EXPECT_LT(cv::countNonZero(here != there), pixels * 2 / 5) << "a jump";
            const cv::Mat both = here & there;
            EXPECT_GT(cv::norm(now.colour, next.colour, cv::NORM_L1, both), pixels);
        }
        double most = 0;
        cv::minMaxLoc(covered, nullptr, &most);
        EXPECT_LT(most, 0.8 * instants) << "all of the scenery is visible at some time";
    }
}

/// The middle, on the floor, of the points that the camera sees in front of the scenery.
std::optional<Vector3d> middle_of_performers(const StageCamera& camera, const DepthImage& depth_m,
                                             const DepthImage& set_m) {
    const cv::Mat1b theirs = performers(depth_m, set_m);
    Vector3d sum(0, 0, 0);
    int pixels = 0;
    for (int y = 0; y < theirs.rows; ++y)
        for (int x = 0; x < theirs.cols; ++x) {
            if (theirs(y, x) == 0) continue;
            const Vector3d point =
                camera.world_from_camera * (camera.K.inverse() * Vector3d(x, y, 1) * depth_m(y, x));
            sum += Vector3d(point.x(), 0, point.z());
            ++pixels;
        }
    if (pixels < 100) return std::nullopt;
    return sum / pixels;
}

TEST_F(StageMotion, VisiblePerformersWalkAtTheirSpeed) {
    std::uint64_t seed = 1;
    while (make_random_background(seed).performers.size() != 1) ++seed;
    const PerformerStyle alone = make_random_background(seed).performers.front();
    stage_ = VirtualStage(library_, seed);
    const DepthImage set_m = this->set_m();
    for (const nanoseconds date : {a_day, years_later}) {
        // From second to second over a loop; the front of a body is nearer than its axis, and what
        // stands before hides some of it, so that a single second errs.
        double way_m = 0;
        int seconds = 0;
        std::optional<Vector3d> before;
        for (int second = 0; second <= 24; ++second) {
            const std::optional<Vector3d> place =
                middle_of_performers(camera_, film_depth_m(date + second * 1s), set_m);
            if (place && before) {
                way_m += (*place - *before).norm();
                ++seconds;
            }
            before = place;
        }
        EXPECT_GT(seconds, 12);
        const double arc = alone.speed_m_per_s() / static_cast<double>(alone.walk_radius_m);
        const double chord_m = 2 * static_cast<double>(alone.walk_radius_m) * std::sin(0.5 * arc);
        EXPECT_NEAR(way_m / seconds, chord_m, 0.15 * chord_m);
    }
}

/// The share of A's performers' points that B sees a surface at, within 3 cm.
double agreeing(const StageCamera& a, const DepthImage& depth_a, const cv::Mat1b& theirs,
                const StageCamera& b, const DepthImage& depth_b) {
    int seen = 0, agreeing = 0;
    for (int y = 0; y < depth_a.rows; ++y)
        for (int x = 0; x < depth_a.cols; ++x) {
            if (theirs(y, x) == 0) continue;
            const Vector3d in_b = b.world_from_camera.inverse() * a.world_from_camera *
                                  (a.K.inverse() * Vector3d(x, y, 1) * depth_a(y, x));
            const Vector3d pixel = b.K * in_b / in_b.z();
            const int u = static_cast<int>(std::lround(pixel.x())),
                      v = static_cast<int>(std::lround(pixel.y()));
            if (u < 0 || v < 0 || u >= depth_b.cols || v >= depth_b.rows) continue;
            ++seen;
            agreeing += std::abs(depth_b(v, u) - in_b.z()) < 0.03;
        }
    EXPECT_GT(seen, 200);
    return static_cast<double>(agreeing) / seen;
}

TEST_F(StageMotion, RigsSeeTheSameInstantWhateverTheyFilmedBefore) {
    const DepthImage set_m = this->set_m();
    const StageCamera other = small_camera({0.4, 1.8, 4.45});
    for (const nanoseconds date : {a_day, years_later}) {
        const DepthImage ours = film_depth_m(date);
        const cv::Mat1b theirs = performers(ours, set_m);
        DepthImage same, at_once, too_late;
        // As another process would: a context of its own, in which nothing was filmed yet.
        std::thread([&] {
            const EglContext context;
            const ShaderLibrary library;
            VirtualStage stage(library);
            same = stage.render(camera_, date).depth_m;
            at_once = stage.render(other, date).depth_m;
            too_late = stage.render(other, date + 100ms).depth_m;
        }).join();
        EXPECT_EQ(cv::norm(same, ours, cv::NORM_INF), 0);
        const double agree = agreeing(camera_, ours, theirs, other, at_once);
        EXPECT_GT(agree, 0.75) << "but for outlines, and what the other does not see";
        EXPECT_LT(agreeing(camera_, ours, theirs, other, too_late), agree - 0.1);
    }
}

}  // namespace
}  // namespace vantage
