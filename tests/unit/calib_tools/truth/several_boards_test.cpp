#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calib_tools/pictures/seen_picture.h"
#include "tests/unit/calib_tools/rig/synthetic_views.h"
#include "tests/unit/calib_tools/truth/place_errors.h"

namespace vantage {
namespace {

BoardPattern charuco(const std::string& size, double square_m, int first_marker) {
    BoardPattern pattern = chessboard_pattern(size, square_m);
    pattern.kind = BoardKind::charuco;
    pattern.marker_m = 0.7 * square_m;
    pattern.dictionary = "4X4_250";
    pattern.first_marker = first_marker;
    return pattern;
}

constexpr int width_px = 1280, stage_seed = 21;

/// The rigs as a chessboard leaves them that each saw from near, in twenty-five pairs: its corners
/// are where they are in truth but for the noise of a good fit.
std::vector<StageRig> calibrate_rigs() {
    const BoardPattern pattern = chessboard_pattern("9x6", 0.1);
    const RenderedStage stage(pattern, width_px, stage_seed);
    SyntheticViews views(pattern, 0.03, 5);
    std::vector<StageRig> rigs;
    for (int r = 0; r < RenderedStage::rig_count; ++r) {
        const StereoCalibration& truth = stage.truth(r);
        std::vector<SeenPicture> left, right;
        while (left.size() < 25) {
            const Pose pose = views.hold_board(1.6, 0.3);
            const std::string number = std::to_string(left.size());
            const SeenPicture on_left = views.see(truth.left, pose, "left" + number);
            const SeenPicture on_right =
                views.see(truth.right, truth.right_from_left * pose, number);
            if (!on_left.sighting.found() || !on_right.sighting.found()) continue;
            left.push_back(on_left);
            right.push_back(on_right);
        }
        const RigCalibration solved =
            calibrate_rig(left, right, pattern, {.family = &lens_family("brown4")});
        StageRig rig;
        rig.name = RenderedStage::name(r);
        rig.calibration = solved.calibration;
        rig.sigma = calibration_sigma(solved);
        rigs.push_back(rig);
    }
    return rigs;
}

/// Once for all tests: the stage has the same rigs whatever boards it shows.
const std::vector<StageRig>& calibrated_rigs() {
    static const std::vector<StageRig> rigs = calibrate_rigs();
    return rigs;
}

/// Films boards that stand about the stage at an instant, with all cameras of rigs first to last.
void film_boards(RenderedStage& stage, const CalibrationBoards& boards, long long instant,
                 const std::vector<RenderedStage::StandingBoard>& standing,
                 std::vector<StageRig>& rigs, int first = 0,
                 int last = RenderedStage::rig_count - 1) {
    for (int r = first; r <= last; ++r)
        for (const int side : {0, 1}) {
            const BoardSighting seen = find_board(stage.film(r, side, standing, {}), boards);
            StageRig& rig = rigs[static_cast<std::size_t>(r)];
            if (seen.found()) (side == 0 ? rig.left : rig.right)[instant] = seen.corners;
        }
}

void expect_within_bounds(const StageCalibration& solved, const RenderedStage& stage) {
    const PlaceErrors errors = place_errors(solved, stage);
    testing::Test::RecordProperty("rms_mm", std::to_string(errors.rms_mm));
    testing::Test::RecordProperty("rms_deg", std::to_string(errors.rms_deg));
    testing::Test::RecordProperty("z_rms", std::to_string(errors.z_rms));
    EXPECT_LT(errors.rms_mm, 1.0);
    EXPECT_LT(errors.rms_deg, 0.02);
    EXPECT_LT(errors.z_rms, 2);
}

TEST(SeveralBoards, of_different_markers_join_four_rigs_in_one_calibration) {
    const std::vector<BoardPattern> patterns = {charuco("7x4", 0.1, 0), charuco("7x4", 0.1, 20),
                                                charuco("7x4", 0.1, 40)};
    CalibrationBoards boards;
    boards.add("floor", {patterns[0]});
    boards.add("left", {patterns[1]});
    boards.add("right", {patterns[2]});
    RenderedStage stage(patterns, width_px, stage_seed);
    std::vector<StageRig> rigs = calibrated_rigs();
    long long instant = 0;
    // The one on the floor stays there while two assistants carry the others about, each before
    // another pair of rigs.
    const RenderedStage::StandingBoard floor{0, stage.board_on_floor()};
    for (int i = 0; i < 6; ++i) {
        film_boards(stage, boards, instant++,
                    {floor, {1, stage.board_before_pair(0)}, {2, stage.board_before_pair(2)}},
                    rigs);
        film_boards(stage, boards, instant++, {floor, {2, stage.board_before_pair(1)}}, rigs, 1, 2);
    }
    const StageCalibration solved = calibrate_stage(rigs, boards, Floor(0, "floor"));
    EXPECT_EQ(solved.bodies.size(), 3u);
    expect_within_bounds(solved, stage);
    for (std::size_t r = 0; r < 4; ++r)
        EXPECT_LT((solved.rigs[r].calibration.world_from_left.translation() -
                   stage.truth(static_cast<int>(r)).world_from_left.translation())
                      .norm(),
                  0.006)
            << r;
}

TEST(SeveralBoards, fixed_to_a_wand_join_rigs_that_see_different_faces) {
    std::vector<BoardPattern> faces;
    for (int f = 0; f < 5; ++f) faces.push_back(charuco("4x4", 0.075, 12 * f));
    RenderedStage stage(faces, width_px, stage_seed);
    std::vector<StageRig> rigs = calibrated_rigs();
    CalibrationBoards boards;
    boards.add("wand", faces);
    const std::vector<Pose> on_cube = cube_faces(faces.front());
    for (int i = 0; i < 18; ++i) {
        const Pose world_from_wand = stage.wand_in_the_middle();
        std::vector<RenderedStage::StandingBoard> standing;
        for (std::size_t f = 0; f < faces.size(); ++f)
            standing.push_back({f, world_from_wand * on_cube[f]});
        film_boards(stage, boards, i, standing, rigs);
    }
    const StageCalibration solved = calibrate_stage(rigs, boards, std::nullopt);
    expect_within_bounds(solved, stage);
    ASSERT_EQ(solved.bodies.size(), 1u);
    const StageCalibration::Body& wand = solved.bodies.front();
    ASSERT_EQ(wand.boards.size(), 5u);
    const Pose first = on_cube[static_cast<std::size_t>(wand.boards[0])];
    for (std::size_t i = 1; i < wand.boards.size(); ++i) {
        const Pose miss = wand.body_from_board[i].inverse() * first.inverse() *
                          on_cube[static_cast<std::size_t>(wand.boards[i])];
        EXPECT_LT(miss.translation().norm(), 4 * wand.translation_sigma_m[i]) << i;
        EXPECT_LT(wand.translation_sigma_m[i], 0.002) << i;
    }
}

}  // namespace
}  // namespace vantage
