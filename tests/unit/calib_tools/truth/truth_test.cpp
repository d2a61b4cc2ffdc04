#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calib_tools/stage/stage_calibration.h"
#include "tests/unit/calib_tools/truth/place_errors.h"

namespace vantage {
namespace {

const BoardPattern pattern = chessboard_pattern("9x6", 0.1);

SeenPicture look(const GreyImage& picture, int number, const BoardPattern& board = pattern) {
    return look_at_picture(picture, std::to_string(number) + ".png", board);
}

/// Everything a technician films and gets, once for all tests: ten boards near each of four rigs,
/// then six before each pair of neighbours and one on the floor.
struct Film {
    RenderedStage stage{pattern, 640, 5};
    std::vector<RigCalibration> rigs;
    StageCalibration held, refined;

    Film() {
        std::vector<StageRig> stage_rigs;
        for (int r = 0; r < RenderedStage::rig_count; ++r) {
            std::vector<SeenPicture> seen[2];
            for (int i = 0; i < 10; ++i) {
                const Pose world_from_board = stage.world_from_board_near(r);
                for (const int side : {0, 1})
                    seen[side].push_back(look(stage.film(r, side, world_from_board, {}), i));
            }
            rigs.push_back(
                calibrate_rig(seen[0], seen[1], pattern, {.family = &lens_family("brown4")}));
            StageRig rig;
            rig.name = RenderedStage::name(r);
            rig.calibration = rigs.back().calibration;
            rig.sigma = calibration_sigma(rigs.back());
            stage_rigs.push_back(rig);
        }
        long long instant = 0;
        const auto show = [&](const Pose& world_from_board, int first, int last) {
            for (int r = first; r <= last; ++r)
                for (const int side : {0, 1}) {
                    const SeenPicture seen = look(stage.film(r, side, world_from_board, {}), 0);
                    StageRig& rig = stage_rigs[static_cast<std::size_t>(r)];
                    if (seen.sighting.found())
                        (side == 0 ? rig.left : rig.right)[instant] = seen.sighting.corners;
                }
            ++instant;
        };
        show(stage.board_on_floor(), 0, RenderedStage::rig_count - 1);
        for (int pair = 0; pair + 1 < RenderedStage::rig_count; ++pair)
            for (int i = 0; i < 6; ++i) show(stage.board_before_pair(pair), pair, pair + 1);
        refined = calibrate_stage(stage_rigs, pattern, 0);
        for (StageRig& rig : stage_rigs) rig.sigma.reset();
        held = calibrate_stage(stage_rigs, pattern, 0);
    }
};

const Film& film() {
    static const Film filmed;
    return filmed;
}

const CameraModel& camera_of(const StereoCalibration& rig, int side) {
    return side == 0 ? rig.left : rig.right;
}

TEST(RenderedBoards, give_lenses_within_a_thousandth_and_uncertainties_that_cover_the_truth) {
    double z_squares = 0;
    int count = 0;
    for (int r = 0; r < RenderedStage::rig_count; ++r)
        for (const int side : {0, 1}) {
            const RigCalibration& rig = film().rigs[static_cast<std::size_t>(r)];
            const CameraModel& truth = camera_of(film().stage.truth(r), side);
            const CameraModel& solved = camera_of(rig.calibration, side);
            const BundleUncertainty::Camera& sigma =
                rig.uncertainty.cameras[static_cast<std::size_t>(side)];
            EXPECT_NEAR(solved.fx_px, truth.fx_px, 1e-3 * truth.fx_px);
            EXPECT_NEAR(solved.fy_px, truth.fy_px, 1e-3 * truth.fy_px);
            EXPECT_NEAR(solved.cx_px, truth.cx_px, 1e-3 * truth.width_px);
            EXPECT_NEAR(solved.cy_px, truth.cy_px, 1e-3 * truth.width_px);
            std::vector<double> z = {(solved.fx_px - truth.fx_px) / sigma.fx_px,
                                     (solved.fy_px - truth.fy_px) / sigma.fy_px,
                                     (solved.cx_px - truth.cx_px) / sigma.cx_px,
                                     (solved.cy_px - truth.cy_px) / sigma.cy_px};
            for (std::size_t k = 0; k < 4; ++k)
                z.push_back((solved.distortion[k] - truth.distortion[k]) / sigma.distortion[k]);
            for (const double value : z) {
                EXPECT_LT(std::abs(value), 4) << "rig " << r << " side " << side;
                z_squares += value * value;
                ++count;
            }
        }
    // As many sigmas as they claim: 1 in the mean square, more if boasted, less if timid.
    const double z_rms = std::sqrt(z_squares / count);
    RecordProperty("z_rms", std::to_string(z_rms));
    EXPECT_LT(z_rms, 1.4);
    EXPECT_GT(z_rms, 0.4);
}

TEST(RenderedBoards, of_charuco_give_lenses_within_a_thousandth_too) {
    BoardPattern charuco = chessboard_pattern("8x5", 0.1);
    charuco.kind = BoardKind::charuco;
    charuco.marker_m = 0.07;
    charuco.dictionary = "4X4_100";
    RenderedStage stage(charuco, 640, 8);
    std::vector<SeenPicture> seen[2];
    // Its corners are measured over smaller circles, which end at the markers: more pictures.
    for (int i = 0; i < 16; ++i) {
        const Pose world_from_board = stage.world_from_board_near(0);
        for (const int side : {0, 1}) {
            seen[side].push_back(look(stage.film(0, side, world_from_board, {}), i, charuco));
            EXPECT_GE(seen[side].back().sighting.corners.size(), 20u)
                << seen[side].back().sighting.reason;
        }
    }
    const RigCalibration rig =
        calibrate_rig(seen[0], seen[1], charuco, {.family = &lens_family("brown4")});
    for (const int side : {0, 1}) {
        const CameraModel& truth = camera_of(stage.truth(0), side);
        const CameraModel& solved = camera_of(rig.calibration, side);
        const BundleUncertainty::Camera& sigma =
            rig.uncertainty.cameras[static_cast<std::size_t>(side)];
        EXPECT_NEAR(solved.fx_px, truth.fx_px, 1e-3 * truth.fx_px);
        EXPECT_NEAR(solved.fy_px, truth.fy_px, 1e-3 * truth.fy_px);
        EXPECT_NEAR(solved.fx_px, truth.fx_px, 4 * sigma.fx_px);
        EXPECT_NEAR(solved.cx_px, truth.cx_px, 4 * sigma.cx_px);
        EXPECT_NEAR(solved.cy_px, truth.cy_px, 4 * sigma.cy_px);
    }
    EXPECT_NEAR(rig.baseline_m, stage.truth(0).right_from_left.translation().norm(),
                4 * rig.baseline_sigma_m);
    EXPECT_LT(rig.row_rms_px, 0.05);
}

TEST(RenderedBoards, give_baselines_that_their_uncertainty_covers) {
    for (int r = 0; r < RenderedStage::rig_count; ++r) {
        const RigCalibration& rig = film().rigs[static_cast<std::size_t>(r)];
        const double truth = film().stage.truth(r).right_from_left.translation().norm();
        EXPECT_NEAR(rig.baseline_m, truth, 4 * rig.baseline_sigma_m) << r;
        EXPECT_NEAR(rig.baseline_m, truth, 1e-3 * truth) << r;
        EXPECT_LT(rig.row_rms_px, 0.05);
    }
}

TEST(RenderedBoards, place_four_rigs_on_an_arc_to_a_millimetre_and_say_how_sure_that_is) {
    const PlaceErrors errors = place_errors(film().refined, film().stage);
    RecordProperty("rms_mm", std::to_string(errors.rms_mm));
    RecordProperty("rms_deg", std::to_string(errors.rms_deg));
    EXPECT_LT(errors.rms_mm, 1.0);
    EXPECT_LT(errors.rms_deg, 0.02);
    EXPECT_LT(errors.z_rms, 2);
    for (std::size_t i = 1; i < film().refined.rigs.size(); ++i)
        EXPECT_LT(film().refined.rigs[i].translation_sigma_m, 0.003) << i;
}

TEST(RenderedBoards, place_the_world_where_the_board_lies_on_the_floor) {
    for (int r = 0; r < RenderedStage::rig_count; ++r) {
        const Pose& solved =
            film().refined.rigs[static_cast<std::size_t>(r)].calibration.world_from_left;
        const Pose& truth = film().stage.truth(r).world_from_left;
        EXPECT_LT((solved.translation() - truth.translation()).norm(), 0.006) << r;
    }
}

TEST(RenderedBoards, refine_lenses_on_the_stage_without_leaving_what_the_rig_knew) {
    const PlaceErrors held = place_errors(film().held, film().stage);
    const PlaceErrors refined = place_errors(film().refined, film().stage);
    RecordProperty("held_mm", std::to_string(held.rms_mm));
    RecordProperty("refined_mm", std::to_string(refined.rms_mm));
    for (std::size_t i = 0; i < film().refined.rigs.size(); ++i) {
        EXPECT_TRUE(film().refined.rigs[i].refined);
        EXPECT_FALSE(film().held.rigs[i].refined);
        EXPECT_LT(film().refined.rigs[i].focal_change, 1e-3);
        EXPECT_LE(film().refined.rigs[i].sigma->left.fx_px,
                  film().rigs[i].uncertainty.cameras[0].fx_px);
    }
    // Held lenses are not doubted, so what they err by is missing in the uncertainties.
    EXPECT_LT(film().held.rigs[3].translation_sigma_m, film().refined.rigs[3].translation_sigma_m);
    EXPECT_LT(film().refined.rms_px, film().held.rms_px);
}

}  // namespace
}  // namespace vantage
