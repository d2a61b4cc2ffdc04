#include <fstream>
#include <random>

#include <gtest/gtest.h>

#include "host_app/flight/flight_plan.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/host_app/flight/looking.h"

namespace vantage {
namespace {

class FlightFile : public testing::Test {
  protected:
    FlightBook read(const std::string& text) {
        std::ofstream(path_) << text;
        return load_flight(path_);
    }
    std::string refusal(const std::string& text) {
        return thrown_sentence([&] { (void)read(text); });
    }
    static void expect_same(const OrbitView& a, const OrbitView& b) {
        EXPECT_TRUE(a.world_from_camera().isApprox(b.world_from_camera(), 1e-7));
        EXPECT_NEAR(a.distance_m, b.distance_m, 1e-7);
        EXPECT_NEAR(a.field_of_view_rad, b.field_of_view_rad, 1e-8);
        EXPECT_NEAR(a.azimuth_rad, b.azimuth_rad, 1e-7) << "whole turns count";
    }

    TemporaryFolder folder_;
    std::filesystem::path path_ = folder_.path() / "flight.toml";
};

TEST_F(FlightFile, WritesAndReadsShotsAndMovesOfBothPaths) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(0, 1);
    for (const MovePath path : {MovePath::orbit, MovePath::free}) {
        FlightBook book;
        std::vector<MoveKeyframe> keyframes;
        for (int i = 0; i < 8; ++i) {
            OrbitView view;
            view.pivot_m = {any(random), 1 + any(random), any(random)};
            view.azimuth_rad = 9 * any(random) - 3;
            view.elevation_rad = any(random);
            view.distance_m = 1 + 3 * any(random);
            view.field_of_view_rad = 0.4 + any(random);
            view.roll_rad = any(random) - 0.5;
            keyframes.push_back(
                {i * (1 + any(random)) * 0.5, view, static_cast<Easing>(i % 4), 12 + any(random)});
            if (i == 0) keyframes.back().time_s = 0;
            if (i == 3) book.shots[2] = Shot{"close \"up\" \\ 3", view, 2.5, Easing::linear};
        }
        std::sort(keyframes.begin(), keyframes.end(),
                  [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
        book.move.emplace(keyframes, false, FlightLimits{}, path);
        const FlightBook again = read(to_toml(book));
        ASSERT_TRUE(again.move);
        EXPECT_EQ(again.move->path(), path);
        ASSERT_EQ(again.move->keyframes().size(), keyframes.size());
        for (std::size_t i = 0; i < keyframes.size(); ++i) {
            const MoveKeyframe& there = again.move->keyframes()[i];
            EXPECT_NEAR(there.time_s, keyframes[i].time_s, 1e-7);
            EXPECT_NEAR(*there.take_s, *keyframes[i].take_s, 1e-7);
            EXPECT_EQ(there.easing, keyframes[i].easing);
            expect_same(there.view, keyframes[i].view);
        }
        ASSERT_TRUE(again.shots[2]);
        EXPECT_EQ(again.shots[2]->name, "close \"up\" \\ 3");
        EXPECT_EQ(again.shots[2]->duration_s, 2.5);
        EXPECT_EQ(again.shots[2]->easing, Easing::linear);
        expect_same(again.shots[2]->view, book.shots[2]->view);
        EXPECT_FALSE(again.shots[0]);
        EXPECT_EQ(to_toml(again), to_toml(book));
    }
}

TEST_F(FlightFile, ReadsBackACameraAtItsLimits) {
    const FlightLimits limits;
    for (int i = 0; i < 200; ++i) {
        OrbitView view;
        view.distance_m = 3 + 0.01234567891 * i;
        view.elevation_rad = i % 2 ? 2 : -2;
        view.pivot_m.y() = 0.3 + 0.003 * i;
        FlightBook book;
        book.shots[0] = Shot{"low", constrained(view, limits)};
        expect_same(read(to_toml(book)).shots[0]->view, constrained(view, limits));
    }
}

TEST_F(FlightFile, KeepsAStageThatReachesBelowTheOrigin) {
    FlightBook book;
    book.lowest_m = -3;
    OrbitView low;
    low.pivot_m.y() = -2;
    book.shots[0] = Shot{"low", low};
    const FlightBook again = read(to_toml(book));
    EXPECT_EQ(again.lowest_m, -3);
    expect_same(again.shots[0]->view, low);
}

TEST_F(FlightFile, ReadsPanAndTilt) {
    const FlightBook book = read(R"(version = 1
path = "free"
[[keyframe]]
time_s = 0
eye_m = [0, 4, 0]
pan_deg = 90
tilt_deg = -90
roll_deg = 5
focus_m = 6
[[keyframe]]
time_s = 2
tilt_deg = -10
)");
    const CameraState first = book.move->at(0).camera();
    EXPECT_TRUE(first.world_from_camera.translation().isApprox(Eigen::Vector3d(0, 4, 0)));
    EXPECT_TRUE(first.world_from_camera.linear().col(2).isApprox(-Eigen::Vector3d::UnitY(), 1e-6));
    EXPECT_EQ(first.focus_m, 6);
    const CameraState last = book.move->at(2).camera();
    EXPECT_TRUE(last.world_from_camera.translation().isApprox(Eigen::Vector3d(0, 4, 0)));
    EXPECT_NEAR(last.world_from_camera.linear().col(2).y(), std::sin(-10 * deg), 1e-9);
}

TEST_F(FlightFile, RejectsInvalidValuesWithFileLineAndReason) {
    const std::string head = "version = 1\n", key = "[[keyframe]]\ntime_s = 0\n",
                      shot = "[[shot]]\nnumber = 1\n";
    const struct {
        std::string text, line, reason;
    } cases[] = {
        {head + "path = \"straight\"\n" + key, ":2:", "straight"},
        {head + key + "pan_deg = 3\npivot_m = [0, 1, 0]\n", ":5:", "pan_deg"},
        {head + key + "pan_deg = 3\ntarget_m = [0, 1, 0]\n", ":5:", "target_m"},
        {head + key + "take_s = 3\n[[keyframe]]\ntime_s = 1\n", ":6:", "take_s"},
        {head + key + "[[keyframe]]\ntime_s = 1\ntake_s = 3\n", ":6:", "take_s"},
        {head + "path = \"free\"\n" + key + "eye_m = [0, -1, 0]\npan_deg = 0\n", ":4:", "lowest_m"},
        {head + shot + "number = 1\n", ":", "number"},
        {head + shot + shot, ":5:", "second time"},
        {head + "[[shot]]\nnumber = 10\n", ":3:", "9"},
        {head + "[[shot]]\nname = \"a\"\n", ":", "number"},
        {head + shot + "duration_s = 90\n", ":4:", "60"},
        {head + shot + "easing = \"smooth\"\n", ":4:", "smooth"},
        {head + shot + "name = \"a\\u0007\"\n", ":4:", "name"},
        {head + "loop = true\n" + key, ":2:", "first"},
    };
    for (const auto& c : cases) {
        const std::string sentence = refusal(c.text);
        EXPECT_NE(sentence.find("flight.toml" + c.line), std::string::npos) << sentence << "\n"
                                                                            << c.text;
        EXPECT_NE(sentence.find(c.reason), std::string::npos) << sentence << "\n" << c.text;
    }
    EXPECT_NE(thrown_sentence([&] {
                  (void)read(head + shot);
                  (void)Move::load(path_);
              }).find("no move"),
              std::string::npos);
}

}  // namespace
}  // namespace vantage
