#include "calib_tools/stage/stage_calibration.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/calib_tools/rig/synthetic_views.h"

namespace vantage {
namespace {

using testing::HasSubstr;

const BoardPattern pattern = chessboard_pattern("9x6", 0.1);
constexpr long long floor_number = 0;

/// Four rigs on an arc of 120 degrees, 4 m from the middle of the stage; the board in front of one
/// pair of neighbours after the other, and once on the floor.
struct FilmedStage {
    std::vector<StageRig> rigs;
    std::vector<Pose> world_from_left;
};

FilmedStage film(int count_a_pair, bool tie_last = true, std::uint64_t seed = 1) {
    FilmedStage stage;
    const SyntheticRig optics;
    for (int i = 0; i < 4; ++i) {
        StageRig rig;
        rig.name = std::string(1, static_cast<char>('A' + i));
        rig.calibration.left = optics.left;
        rig.calibration.right = optics.right;
        rig.calibration.right_from_left = optics.right_from_left;
        stage.rigs.push_back(rig);
        const double azimuth = (i - 1.5) * 40 * std::numbers::pi / 180;
        stage.world_from_left.push_back(
            look_at({4 * std::sin(azimuth), 1.6, 4 * std::cos(azimuth)}, {0, 0.8, 0}));
    }
    SyntheticViews views(pattern, 0.1, seed);
    long long instant = floor_number;
    const auto show = [&](const Pose& world_from_board) {
        for (std::size_t i = 0; i < 4; ++i) {
            const Pose left_from_board = stage.world_from_left[i].inverse() * world_from_board;
            // Only the front can be read.
            if ((left_from_board.linear().col(2)).dot(left_from_board.translation()) <= 0) continue;
            if (!tie_last && i == 3 && instant != floor_number) continue;
            if (!tie_last && i == 3) continue;
            const auto l = views.see(stage.rigs[i].calibration.left, left_from_board, "l");
            const auto r =
                views.see(stage.rigs[i].calibration.right,
                          stage.rigs[i].calibration.right_from_left * left_from_board, "r");
            if (l.sighting.found()) stage.rigs[i].left[instant] = l.sighting.corners;
            if (r.sighting.found()) stage.rigs[i].right[instant] = r.sighting.corners;
        }
        ++instant;
    };
    Pose floor = Pose::Identity();
    floor.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    floor.translation() = -(floor.linear() * (0.5 * pattern.corner_m(pattern.corner_count() - 1)));
    show(floor);
    for (int pair = 0; pair < 3; ++pair)
        for (int k = 0; k < count_a_pair; ++k) {
            // A camera half way between two rigs holds the board before itself.
            const double azimuth = (pair - 1) * 40 * std::numbers::pi / 180;
            const Pose between =
                look_at({4 * std::sin(azimuth), 1.6, 4 * std::cos(azimuth)}, {0, 0.9, 0});
            show(between * views.hold_board(3.2, 0.12));
        }
    if (!tie_last) stage.rigs[3].left[1000] = stage.rigs[0].left.begin()->second;
    return stage;
}

struct Miss {
    double translation_m = 0, rotation_rad = 0;
};

/// Of a rig against the first one, as the uncertainties are stated.
Miss miss_of(const StageCalibration& stage, const FilmedStage& filmed, std::size_t rig) {
    const Pose solved = stage.rigs[0].calibration.world_from_left.inverse() *
                        stage.rigs[rig].calibration.world_from_left;
    const Pose truth = filmed.world_from_left[0].inverse() * filmed.world_from_left[rig];
    return {
        (solved.translation() - truth.translation()).norm(),
        Eigen::AngleAxisd(Eigen::Matrix3d(solved.linear().transpose() * truth.linear())).angle()};
}

TEST(StageCalibration, errs_by_as_much_as_it_says_over_many_films) {
    constexpr std::uint64_t films = 8;
    double squares = 0;
    int count = 0;
    for (std::uint64_t seed = 1; seed <= films; ++seed) {
        const FilmedStage filmed = film(8, true, 200 + seed);
        const StageCalibration stage = calibrate_stage(filmed.rigs, pattern, floor_number);
        for (std::size_t i = 1; i < 4; ++i) {
            const Miss miss = miss_of(stage, filmed, i);
            squares += std::pow(miss.translation_m / stage.rigs[i].translation_sigma_m, 2) +
                       std::pow(miss.rotation_rad / stage.rigs[i].rotation_sigma_rad, 2);
            count += 2;
        }
    }
    const double normalized_rms = std::sqrt(squares / count);
    RecordProperty("normalized_rms", std::to_string(normalized_rms));
    EXPECT_GT(normalized_rms, 0.7);
    EXPECT_LT(normalized_rms, 1.3);
}

TEST(StageCalibration, places_four_rigs_on_an_arc_and_its_uncertainty_covers_the_truth) {
    const FilmedStage filmed = film(13);
    const StageCalibration stage = calibrate_stage(filmed.rigs, pattern, floor_number);
    ASSERT_EQ(stage.rigs.size(), 4u);
    EXPECT_TRUE(stage.has_floor);
    double squares_m = 0, squares_rad = 0;
    for (std::size_t i = 1; i < 4; ++i) {
        const auto [miss_m, miss_rad] = miss_of(stage, filmed, i);
        squares_m += miss_m * miss_m / 3;
        squares_rad += miss_rad * miss_rad / 3;
        EXPECT_LT(miss_m, 3 * stage.rigs[i].translation_sigma_m) << i;
        EXPECT_LT(miss_rad, 3 * stage.rigs[i].rotation_sigma_rad) << i;
        EXPECT_LT(stage.rigs[i].translation_sigma_m, 0.003);
    }
    EXPECT_LT(std::sqrt(squares_m), 0.001);
    EXPECT_LT(std::sqrt(squares_rad) * 180 / std::numbers::pi, 0.02);
    // The floor fixes the world: the first rig stands where it was put.
    EXPECT_LT((stage.rigs[0].calibration.world_from_left.translation() -
               filmed.world_from_left[0].translation())
                  .norm(),
              0.01);
}

TEST(StageCalibration, names_the_rig_that_no_board_ties_to_the_others) {
    try {
        calibrate_stage(film(3, false).rigs, pattern, std::nullopt);
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("no picture shows the board to D and to A, B, C"));
    }
}

TEST(StageCalibration, says_which_rig_is_weakly_tied) {
    FilmedStage filmed = film(8);
    int kept = 0;
    for (auto* series : {&filmed.rigs[3].left, &filmed.rigs[3].right}) {
        kept = 0;
        std::erase_if(*series, [&](const auto&) { return ++kept > 2; });
    }
    const StageCalibration stage = calibrate_stage(filmed.rigs, pattern, std::nullopt);
    ASSERT_FALSE(stage.advice.empty());
    EXPECT_THAT(stage.advice.back(), HasSubstr("rig D is weakly tied"));
    // Its neighbour sees a board with it at a better angle than the others do.
    ASSERT_TRUE(stage.next_picture);
    EXPECT_EQ(stage.next_picture->b, 3u);
    EXPECT_EQ(stage.next_picture->rig, 3u);
    EXPECT_LT(stage.next_picture->sigma_then_m, 0.9 * stage.next_picture->sigma_now_m);
}

TEST(StageCalibration, counts_a_board_that_lies_still_once) {
    const FilmedStage filmed = film(8);
    FilmedStage lying = filmed;
    // The board stays on the floor for ninety more instants; its corners tremble a little.
    std::mt19937_64 random(4);
    std::normal_distribution<double> noise(0, 0.02);
    for (StageRig& rig : lying.rigs)
        for (auto* series : {&rig.left, &rig.right}) {
            if (!series->contains(floor_number)) continue;
            for (long long instant = 100; instant < 190; ++instant) {
                BoardCorners& corners = (*series)[instant] = series->at(floor_number);
                for (BoardCorner& corner : corners)
                    corner.pixel += Eigen::Vector2d(noise(random), noise(random));
            }
        }
    const StageCalibration once = calibrate_stage(filmed.rigs, pattern, floor_number);
    const StageCalibration often = calibrate_stage(lying.rigs, pattern, floor_number);
    EXPECT_EQ(often.instants_given, once.instants_given);
    // Two threads solve, and add up in any order.
    EXPECT_NEAR(often.rigs[3].translation_sigma_m / once.rigs[3].translation_sigma_m, 1, 1e-6);
}

TEST(StageCalibration, names_a_board_of_another_size_than_its_description) {
    FilmedStage filmed = film(3);
    BoardPattern described = pattern;
    described.square_m = 0.09;
    for (StageRig& rig : filmed.rigs)
        for (auto* series : {&rig.left, &rig.right})
            for (auto& [instant, corners] : *series)
                for (BoardCorner& corner : corners) corner.board_m = described.corner_m(corner.id);
    EXPECT_THAT(thrown_sentence([&] { calibrate_stage(filmed.rigs, described, std::nullopt); }),
                HasSubstr("m wide by the rigs' own baselines and 0.0900 m by its description"));
}

TEST(StageCalibration, refuses_a_board_that_looks_alike_half_turned) {
    EXPECT_THROW(calibrate_stage(film(1).rigs, chessboard_pattern("8x6", 0.1), std::nullopt),
                 Error);
}

}  // namespace
}  // namespace vantage
